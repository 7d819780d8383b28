// Decides whether two runs differ by rounding, chaos or a defect. Uses only arrays and tolerances,
// no physics.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lib/scene/scene.h"
#include "lib/solver/solver.h"

namespace pbf::verify_module {

/// One side of a comparison: "cpu:double", "cuda:float", "cpu:float@2" (2 threads).
struct CompareSide {
  Backend backend = Backend::cpu;
  Precision precision = Precision::dbl;
  int threads = 0;       ///< 0: as the scene says
  bool variant = false;  ///< cpu+defect: the second CPU solver of a build made with PBF_DEFECT
  std::string name() const;
};

/// Throws Error(bad_input) with the text and the valid forms.
CompareSide parse_side(const std::string& text);

struct CompareSettings {
  CompareSide a, b;
  int warmup = 50;    ///< updates on A before the frozen step
  int updates = 100;  ///< updates after it
  int members = 8;    ///< of the ensemble that determines the tolerances
  std::uint64_t seed = 1;
};

enum class Verdict { same, differs, not_judged };
const char* verdict_name(Verdict v);

/// One line of a report: an error, its tolerance and the verdict.
struct CompareRow {
  std::string what, unit;
  double error = 0;  ///< largest
  double rms = 0;
  double relative = 0;   ///< largest error relative to the largest value
  double ulps = 0;       ///< the same in units in the last place of the coarser precision
  double tolerance = 0;  ///< for `error`
  Verdict verdict = Verdict::not_judged;
};

struct ComparePart {
  std::string name;
  Verdict verdict = Verdict::not_judged;
  std::string finding;           ///< one sentence
  std::string tolerance_source;  ///< how the tolerances were found
  std::vector<CompareRow> rows;
};

struct Curve {
  std::string name;
  std::vector<double> x, y;
};

/// A plot of the JSON report, with a logarithmic y axis.
struct Diagram {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
};

struct CompareResult {
  std::string a, b;                ///< what was compared
  std::vector<std::string> notes;  ///< notes for the reader
  std::vector<ComparePart> parts;
  std::string stage;     ///< the first stage of the frozen step outside its tolerance; "": none
  double e_folding = 0;  ///< updates in which distances grow by a factor e; 0: unknown
  double horizon = -1;   ///< first update with incomparable particles; < 0: none
  std::vector<Diagram> diagrams;
  bool same() const;  ///< no part differs
};

/// Compares two scenes, which are equal except for deliberate changes in B. `dir` anchors file
/// bodies. `progress` gets lines of progress. Throws Error(unavailable) if a backend is missing,
/// Error(bad_input) for a scene that cannot run.
CompareResult compare_between(const Scene& scene_a, const Scene& scene_b, const std::string& dir,
                              const CompareSettings& settings,
                              const std::function<void(const std::string&)>& progress);

/// Compares two run files. Throws Error(io) for an unreadable file, Error(bad_input) if nothing can
/// be compared.
CompareResult compare_files(const std::string& a, const std::string& b);

std::string compare_text(const CompareResult& result);
std::string compare_json(const CompareResult& result);
/// One test case per part and per line of it. `seconds`: total time.
std::string compare_junit(const CompareResult& result, double seconds);

}  // namespace pbf::verify_module
