// Decides whether two runs differ by rounding, by chaos or by a defect. This code knows only arrays
// and tolerances, no physics.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/solver.h"

namespace pbf::inline verify_module {

/// One side of a comparison: "cpu:double", "cuda:float", "cpu:float@2" (2 threads).
struct CompareSide {
  Backend backend = Backend::cpu;
  Precision precision = Precision::dbl;
  int threads = 0;       ///< 0: as the scene says
  bool variant = false;  ///< cpu+defect: the second CPU solver of a build made with PBF_DEFECT
  std::string name() const;
};

/// Throws Error(bad_input) naming the text and what would be right.
CompareSide parse_side(const std::string& text);

struct CompareSettings {
  CompareSide a, b;
  int warmup = 50;    ///< updates on A before the frozen step
  int updates = 100;  ///< updates after it
  int members = 8;    ///< of the ensemble that gives the tolerances
  std::uint64_t seed = 1;
};

enum class Verdict { same, differs, not_judged };
const char* verdict_name(Verdict v);

/// One line of a report: an error, what it may be, and why.
struct CompareRow {
  std::string what, unit;
  double error = 0;  ///< largest
  double rms = 0;
  double relative = 0;   ///< largest error over the largest value
  double ulps = 0;       ///< the same in units of the last place of the coarser precision
  double tolerance = 0;  ///< on `error`
  Verdict verdict = Verdict::not_judged;
};

struct ComparePart {
  std::string name;
  Verdict verdict = Verdict::not_judged;
  std::string finding;           ///< in a sentence
  std::string tolerance_source;  ///< where the tolerances come from
  std::vector<CompareRow> rows;
};

struct Curve {
  std::string name;
  std::vector<double> x, y;
};

/// A diagram of the JSON report; its y axis is logarithmic.
struct Diagram {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
};

struct CompareResult {
  std::string a, b;                ///< what was compared
  std::vector<std::string> notes;  ///< what the reader should know beforehand
  std::vector<ComparePart> parts;
  std::string stage;     ///< where the frozen step first leaves its tolerance; "": nowhere
  double e_folding = 0;  ///< updates in which distances grow by e; 0: not estimated
  double horizon = -1;   ///< updates after which particles are not comparable; < 0: beyond
  std::vector<Diagram> diagrams;
  bool same() const;  ///< no part differs
};

/// The scenes of A and B are the same but for what a caller changed in B on purpose. `dir` anchors
/// file bodies. `progress` is called with a line now and then. Throws Error(unavailable) where a
/// backend is missing, Error(bad_input) for a scene that cannot run.
CompareResult compare_between(const Scene& scene_a, const Scene& scene_b, const std::string& dir,
                              const CompareSettings& settings,
                              const std::function<void(const std::string&)>& progress);

/// Two run files. Throws Error(io) for files that cannot be read, Error(bad_input) where nothing
/// can be compared.
CompareResult compare_files(const std::string& a, const std::string& b);

std::string compare_text(const CompareResult& result);
std::string compare_json(const CompareResult& result);
/// A case for every part and every line of it. `seconds` that it all took.
std::string compare_junit(const CompareResult& result, double seconds);

}  // namespace pbf::inline verify_module
