// Reads the files of prescribed motions, and chooses the step of `time.step: auto` with them.
#pragma once

#include <string>

#include "lib/scene/scene.h"

namespace pbf::run_module {

/// Reads the table of a motion of the scene. key: with its place in the scene file, for messages.
/// Throws Error(bad_input) with key, file and line for an invalid table, for times that do not
/// increase, and for a table that ends before time.motion_begin + time.end; Error(io).
void read_motion(const Scene& scene, Motion& m, const std::string& key, const std::string& file);
void read_motion(const Scene& scene, TankMotion& m, const std::string& key,
                 const std::string& file);
/// The same for the speeds of an emitter, whose table lasts from its start to its end.
void read_motion(const Scene& scene, Emitter& e, const std::string& key, const std::string& file);

/// Chooses time.step from gravity, bodies and motions, after the tables have been read: the fastest
/// obstacle moves by at most kSafeWay h in a step, and the acceleration of a particle at rest in
/// the tank takes the place of gravity. Covers a whole period or table, whatever time.end is.
/// Throws Error(bad_input) if nothing moves, and if the scene violates a rule with this step.
void choose_step_of_motions(Scene& scene);

}  // namespace pbf::run_module
