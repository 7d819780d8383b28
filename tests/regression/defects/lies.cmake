# Seeded lies: one textual change each to what passes and fields declare (lib/program/needs.h,
# lib/program/field.h).
# seeded_defect(NAME TEST FILE OLD NEW): OLD stands in FILE exactly once; TEST is the source in
# tests/unit/solver that must not compile or must fail.
set(lie_tests declarations state_feature)

# what a pass does with a field
seeded_defect(undeclared_read declarations lib/program/features/correction.h
  [[W::inverse_density>, Reads<field::density>,]] [[W::inverse_density>,]])
seeded_defect(undeclared_write declarations lib/program/features/confinement.h
  [[UsesLists, Writes<field::curl>>;]] [[UsesLists>;]])
seeded_defect(undeclared_gather declarations lib/program/features/confinement.h
  [[W::inverse_density>, Gathers<field::velocity>,]] [[W::inverse_density>,]])
seeded_defect(undeclared_gather_of_lambda declarations lib/program/features/constraint.h
  [[Gathers<field::velocity, W::any, When::first_iteration>,]] [[]])
seeded_defect(undeclared_lists declarations lib/program/features/viscosity.h
  [[UsesLists, Adds<field::dissipation>]] [[Adds<field::dissipation>]])
seeded_defect(undeclared_behind_address declarations lib/program/features/solids.h
  [[Needs<If<has_obstacles, Looks<field::solid_scene>, Looks<field::solids>>,]]
  [[Needs<If<has_obstacles, Looks<field::solid_scene>>,]])
seeded_defect(neighbor_of_own_row declarations lib/program/features/confinement.h
  [[Gathers<field::curl>,]] [[Reads<field::curl>,]])
seeded_defect(write_to_what_is_read declarations lib/program/features/confinement.h
  [[Updates<field::velocity>, Adds]] [[Reads<field::velocity>, Adds]])
seeded_defect(read_of_running_sum declarations lib/program/features/loads.h
  [[Updates<field::load_sums>, Updates<field::loads>]]
  [[Adds<field::load_sums>, Updates<field::loads>]])
seeded_defect(update_as_write declarations lib/program/features/solids.h
  [[Updates<field::near_way_left>]] [[Writes<field::near_way_left>]])
seeded_defect(idle_declaration declarations lib/program/features/confinement.h
  [[UsesLists, Writes<field::curl>>;]] [[UsesLists, Reads<field::density>, Writes<field::curl>>;]])
seeded_defect(fused_pass_gathers_what_it_writes declarations lib/program/features/correction.h
  [[Updates<field::position, W::mark>, Updates<field::velocity>,]]
  [[Updates<field::position, W::mark>, Gathers<field::velocity>, Updates<field::velocity>,]])
seeded_defect(array_not_flipped declarations lib/program/features/viscosity.h
  [[using Flips = pbf::Flips<field::velocity>;]] [[using Flips = pbf::Flips<>;]])

# what is in w of positions
seeded_defect(w_of_another_pass declarations lib/program/features/confinement.h
  [[W::inverse_density>, Gathers<field::velocity>,]] [[W::lambda>, Gathers<field::velocity>,]])
seeded_defect(w_not_left declarations lib/program/features/correction.h
  [[Writes<field::position, W::inverse_density>]] [[Writes<field::position>]])

# in which scenes
seeded_defect(if_too_wide declarations lib/program/features/solids.h
  [[If<has_tank_motion, Looks<field::frame>>;]] [[If<has_motion, Looks<field::frame>>;]])
seeded_defect(if_too_narrow declarations lib/program/features/solids.h
  [[NearSumNeeds = If<has_obstacles,]] [[NearSumNeeds = If<has_moving_obstacles,]])
seeded_defect(if_without_memory declarations lib/program/features/loads.h
  [[Adds<field::load_sums>>, If<has_pressure_gauges, Looks<field::patches>>>;]]
  [[Adds<field::load_sums>>, If<has_tank_motion, Looks<field::patches>>>;]])

# how long contents count
seeded_defect(run_as_pass declarations lib/program/features/gauges.h
  [["flow sides", per_id, Life::run]] [["flow sides", per_id, Life::pass]])
seeded_defect(lists_as_pass declarations lib/program/features/solids.h
  [["way left", per_padded_row, Life::lists]] [["way left", per_padded_row, Life::pass]])
seeded_defect(state_as_pass declarations lib/program/features/loads.h
  [["loads", per_wall, Life::state]] [["loads", per_wall, Life::pass]])
seeded_defect(state_as_update declarations lib/program/features/gauges.h
  [["flows", per_sum<FlowTally>, Life::state]] [["flows", per_sum<FlowTally>, Life::update]])
seeded_defect(state_as_rows state_feature tests/unit/solver/state_feature.cpp
  [["temperature", per_padded_row, Life::state, true,]]
  [["temperature", per_padded_row, Life::rows, true,]])
seeded_defect(carried_as_pass state_feature tests/unit/solver/state_feature.cpp
  [["tag", per_particle, Life::rows, true]] [["tag", per_particle, Life::pass, true]])
seeded_defect(carried_without_pair state_feature tests/unit/solver/state_feature.cpp
  [["tag", per_particle, Life::rows, true]] [["tag", per_particle, Life::rows, false]])
seeded_defect(state_without_pair declarations lib/program/field.h
  [["velocity", per_padded_row, Life::state, true,]]
  [["velocity", per_padded_row, Life::state, false,]])
