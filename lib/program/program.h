// The passes of an update: one list that is executed, printed, counted and traced.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lib/program/pass.h"
#include "lib/scene/scene.h"

namespace pbf::program_module {

/// A pass, or a repeated group of steps.
struct ProgramStep {
  enum Kind {
    pass,
    iterate,  ///< `body` for iterations first ... first + times - 1 of a substep
    until     ///< `body` while the mean compression is above the tolerance, at most `times` times
  };
  Kind kind = pass;
  int index = -1;  ///< of the pass in Passes (features.h)
  int first = 0, times = 1;
  std::vector<ProgramStep> body{};
};
using Steps = std::vector<ProgramStep>;

struct LeftOut {
  std::string what, because;  ///< e.g. "xsph", "no key viscosity"
};

struct Program {
  /// An update without fused passes, for traces and checks.
  Steps update;
  /// Updates with fused passes: n updates are first, rest, n - 1 times (next, rest), last. They
  /// give the same bits.
  Steps first, rest, next, last;
  /// The same as first, n - 1 times rest_next, rest_last: lists of passes that may share a launch.
  Steps rest_next, rest_last;
  /// Makes lists at the present positions, for a measurement.
  Steps lists;
  /// Passes behind every update whose number is a multiple of `between_every`.
  Steps between;
  int between_every = 0;  ///< 0: there are none
  Steps readings;         ///< passes that features launch for their readings alone
  bool has_iterations = false;
  /// The declarations of all passes in this scene, by index in Passes.
  std::vector<PassInfo> passes;
  /// All fields of the passes and those that every solver has; of a pair only the first array.
  std::vector<const FieldInfo*> fields;
  std::vector<const FieldInfo*> state;  ///< those of Life::state
  std::vector<CarriedField>
      carried_fields;             ///< those that sorts carry besides position, velocity and id
  std::vector<LeftOut> left_out;  ///< features that the scene does not use

  bool has_pairs() const { return !first.empty(); }  ///< otherwise particles move freely
};

/// A pass and how often it runs (with a tolerance: at most).
struct PassCount {
  const PassInfo* pass;
  int times;
};
std::vector<PassCount> count_passes(const Program& program, const Steps& steps);
/// The same for an update in the middle of a run.
std::vector<PassCount> count_passes(const Program& program);

/// The update of a scene, or its step without time (StepOptions::without_time in lib/solver).
Program make_program(const Scene& scene, const UpdateShape& shape, bool without_time = false);

/// Name, stage and remedy of every pass, by index in Passes.
std::span<const PassText> pass_texts();

/// "position velocity'": the fields that a pass reads, and those that it writes.
std::string reads_text(const PassInfo& pass);
std::string writes_text(const PassInfo& pass);
/// "position lambda": the fields of which it reads the rows of neighbors.
std::string gathers_text(const PassInfo& pass);

}  // namespace pbf::program_module
