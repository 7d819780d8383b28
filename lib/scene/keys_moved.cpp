// Keys of prescribed motions: of obstacles, and of the tank.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)
#define OBSTACLE(member) MEMBER_OF(obstacles, Obstacle, member)

constexpr Range kDegrees{-1e9, 1e9};
constexpr const char* kRamp =
    "Time in which the amplitude grows from 0 to its full value, as (1 - cos(pi t/ramp))/2. 0: no "
    "ramp.";
constexpr const char* kPhase = "Phase of the sine at t = 0.";

KeyRows moved_rows() {
  return {
      {optional_block(
           OBSTACLE(motion),
           "Moves the obstacle from where its other keys put it, as a function of time."),
       optional_block(KEY(tank_motion),
                      "Moves the tank. All coordinates, velocities and loads are in the frame of "
                      "the tank, where the fluid feels the fictitious forces.")},
      {key(OBSTACLE(motion->kind), one_of({"sine", "velocity", "file"}),
           "sine: oscillation. velocity: constant velocity and rotation. file: a table of "
           "positions and angles.",
           required, is_kind),
       key(OBSTACLE(motion->direction), number("", {-1e6, 1e6}),
           "Direction of an oscillation along a line; auto: it rotates about an axis.", automatic,
           of(MotionKind::sine), flat(FlatY::zero)),
       key(OBSTACLE(motion->axis), number("", {-1e6, 1e6}),
           "Axis of an oscillation by rotation (right-hand rule); auto: it moves along a "
           "direction.",
           automatic, of(MotionKind::sine)),
       key(OBSTACLE(motion->amplitude), number("m or degrees", {-1e9, 1e9}),
           "Amplitude: a length along the direction, or an angle about the axis.", required,
           of(MotionKind::sine)),
       key(OBSTACLE(motion->period), number("s", kSeconds), "Period.", required,
           of(MotionKind::sine)),
       key(OBSTACLE(motion->phase), number("degrees", kDegrees), kPhase, of(MotionKind::sine)),
       key(OBSTACLE(motion->ramp), number("s", {0, 1e9}), kRamp, of(MotionKind::sine)),
       key(OBSTACLE(motion->velocity), number("m/s", kRate), "Velocity of the pivot.",
           of(MotionKind::velocity), flat(FlatY::zero)),
       key(OBSTACLE(motion->angular), number("degrees/s", kDegrees),
           "Angular velocity: a rotation about this vector (right-hand rule) at the rate of its "
           "length.",
           of(MotionKind::velocity)),
       key(OBSTACLE(motion->path), plain,
           "CSV file, relative to the scene file, with the header t,x,y,z or t,x,y,z,rx,ry,rz: "
           "time in s, displacement of the pivot in m, rotations about x, then y, then z in "
           "degrees. Cubic between rows.",
           required, of(MotionKind::file), names_file),
       key(OBSTACLE(motion->pivot), number("m", kCoordinate),
           "The point about which it rotates, before it moves; auto: the middle of the obstacle.",
           automatic, flat(FlatY::middle)),
       key(KEY(tank_motion->kind), one_of({"sine", "file"}), "sine: oscillation. file: a table.",
           required, is_kind),
       key(KEY(tank_motion->direction), number("", {-1e6, 1e6}),
           "Direction of an oscillation along a line; auto: the tank rotates about an axis.",
           automatic, of(TankMotionKind::sine), flat(FlatY::zero)),
       key(KEY(tank_motion->axis), number("", {-1e6, 1e6}),
           "Axis of rotation of the tank (right-hand rule); auto: none.", automatic),
       key(KEY(tank_motion->amplitude), number("m or degrees", {-1e9, 1e9}),
           "Amplitude: a length along the direction, or an angle about the axis.", required,
           of(TankMotionKind::sine)),
       key(KEY(tank_motion->period), number("s", kSeconds), "Period.", required,
           of(TankMotionKind::sine)),
       key(KEY(tank_motion->phase), number("degrees", kDegrees), kPhase, of(TankMotionKind::sine)),
       key(KEY(tank_motion->ramp), number("s", {0, 1e9}), kRamp, of(TankMotionKind::sine)),
       key(KEY(tank_motion->path), plain,
           "CSV file, relative to the scene file, with the header t,angle (s, degrees about the "
           "axis; cubic between rows) or t,ax,ay,az (m/s^2, acceleration of the tank; linear "
           "between rows).",
           required, of(TankMotionKind::file), names_file),
       key(KEY(tank_motion->pivot), number("m", kCoordinate),
           "The point about which the tank rotates; auto: the middle of the domain.", automatic,
           flat(FlatY::middle))}};
}

}  // namespace pbf::scene_module
