// The passes of an update: one list that is executed, printed, counted and traced.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lib/program/pass.h"
#include "lib/scene/scene.h"

namespace pbf::inline program_module {

/// A pass, or passes that are repeated.
struct ProgramStep {
  enum Kind {
    pass,
    iterate,  ///< `body` for iterations first ... first + times - 1 of a substep
    until     ///< `body` at most `times` times, while the mean compression is above the tolerance
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
  /// An update pass by pass, as it is observed.
  Steps update;
  /// The same with passes joined that can be: n updates are first, rest, (next, rest) n - 1 times,
  /// last, to the same bits.
  Steps first, rest, next, last;
  /// Makes lists at the present positions, for a measure.
  Steps lists;
  bool has_iterations = false;
  /// What the passes declare in this scene, by index in Passes.
  std::vector<PassInfo> passes;
  /// Every field of the passes, and those that a solver has in any case; of a pair the first.
  std::vector<const FieldInfo*> fields;
  std::vector<LeftOut> left_out;  ///< the features that the scene does without

  bool has_pairs() const { return !first.empty(); }  ///< else particles only move
};

/// A pass, and how often it comes; at most, where a tolerance decides.
struct PassCount {
  const PassInfo* pass;
  int times;
};
std::vector<PassCount> count_passes(const Program& program, const Steps& steps);
/// Those of an update in the middle of a run.
std::vector<PassCount> count_passes(const Program& program);

/// How an update is divided, and what may be repeated.
struct UpdateShape {
  int substeps = 1, lists_per_update = 1, repeats = 0;
};

/// The update of a scene, or its step without time.
Program make_program(const Scene& scene, const UpdateShape& shape, bool without_time = false);

/// Name, stage and remedy of every pass, by index in Passes.
std::span<const PassText> pass_texts();

/// "position velocity'", of the fields that a pass reads, or leaves something in.
std::string reads_text(const PassInfo& pass);
std::string writes_text(const PassInfo& pass);
/// "position lambda", of what it reads of the neighbors' rows.
std::string gathers_text(const PassInfo& pass);

}  // namespace pbf::inline program_module
