// Makes a program of the passes that features add for a scene.
#pragma once

#include "lib/program/program.h"

namespace pbf::program_module {

/// The passes of a scene by their place in an update, and what is known of all passes.
struct PassSet {
  Steps at_start, before_sort, behind_predict, with_lists, with_all_lists, in_iteration,
      behind_iterations, behind, at_end, at_reading;
  Steps between;          ///< behind an update ...
  int between_every = 0;  ///< ... whose number is a multiple of this
  std::vector<LeftOut> without;
  std::vector<PassInfo> infos;
  int (*fused)(int a, int b) = nullptr;  ///< the pass that does the work of a and then b, or -1
  UpdateShape shape;
  ProgramStep predict, sort, make_lists;
  std::vector<CarriedField> carried_fields;
};
Program assembled(const Scene& scene, PassSet passes, bool without_time);

/// Collects the passes that features add.
template <class Passes>
struct Builder : PassSet {
  template <class P>
  static ProgramStep step_of(P) {
    return {ProgramStep::pass, Passes::template index_of<P>()};
  }
  /// The pass runs before each substep.
  void start(auto pass) { at_start.push_back(step_of(pass)); }
  /// The pass runs before each sort of an update. It may add rows behind the last one, and mark
  /// rows that leave (kernels/row_state.h). Rows near solids: NearRows::mark_near() for each new
  /// row.
  void rows(auto pass) { before_sort.push_back(step_of(pass)); }
  /// The pass runs after each prediction, before the sort.
  void predicted(auto pass) { behind_predict.push_back(step_of(pass)); }
  /// The pass runs whenever lists are made; with `updates_alone` not for a measurement.
  void lists(auto pass, bool updates_alone = false) {
    with_lists.push_back(step_of(pass));
    if (!updates_alone) with_all_lists.push_back(step_of(pass));
  }
  void iteration(auto pass) { in_iteration.push_back(step_of(pass)); }
  /// The pass runs behind the last iteration of an update, with which it may be fused.
  void iterated(auto pass) { behind_iterations.push_back(step_of(pass)); }
  void after(auto pass) { behind.push_back(step_of(pass)); }
  /// The pass runs after all others, with or without lists.
  void end(auto pass) { at_end.push_back(step_of(pass)); }
  /// The pass runs with the lists of an update behind it, if the number of the update is a multiple
  /// of `updates`: the same number for all features.
  template <class Pass>
  void every(int updates, Pass pass) {
    static_assert(
        !requires { typename Pass::Flips; }, "a recording ends as it began");
    between.push_back(step_of(pass));
    between_every = updates;
  }
  /// The feature launches the pass itself when it is read.
  void reading(auto pass) { at_reading.push_back(step_of(pass)); }
  void left_out(const char* what, const char* because) { without.push_back({what, because}); }
};

/// The program of a list of features (FeatureList in features.h).
template <class FeatureSet>
Program make_program_of(const Scene& scene, const UpdateShape& shape, bool without_time = false) {
  using Passes = typename FeatureSet::Passes;
  Builder<Passes> b;
  b.shape = shape;
  FeatureSet::add(scene, b);
  b.infos = Passes::infos({scene, shape});
  b.fused = &Passes::fused;
  b.predict = b.step_of(typename FeatureSet::Predict());
  b.sort = b.step_of(typename FeatureSet::Sort());
  b.make_lists = b.step_of(typename FeatureSet::MakeLists());
  b.carried_fields = Passes::carried_fields();
  return assembled(scene, std::move(b), without_time);
}

}  // namespace pbf::program_module
