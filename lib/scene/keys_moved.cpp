// Keys of prescribed motions: of obstacles, and of the tank.
#include "lib/scene/key_rows.h"

namespace pbf::inline scene_module {

#define KEY(member) MEMBER(Scene, member)
#define OBSTACLE(member) MEMBER_OF(obstacles, Obstacle, member)

constexpr Range kDegrees{-1e9, 1e9};
constexpr const char* kRamp =
    "Time in which the amplitude grows from 0, by (1 - cos(pi t/ramp))/2. 0: at once.";
constexpr const char* kPhase = "What the sine begins with.";

KeyRows moved_rows() {
  return {
      {optional_block(OBSTACLE(motion),
                      "Moves the obstacle, from where its other keys put it: a function of time."),
       optional_block(KEY(tank_motion),
                      "Moves the tank. All coordinates, velocities and loads are those seen from "
                      "it; the fluid feels what that makes of gravity.")},
      {key(OBSTACLE(motion->kind), one_of({"sine", "velocity", "file"}),
           "sine: to and fro. velocity: on and on. file: a table of poses.", required, is_kind),
       key(OBSTACLE(motion->direction), number("", {-1e6, 1e6}),
           "It goes along this direction; auto: it turns about an axis.", automatic,
           of(MotionKind::sine), flat(FlatY::zero)),
       key(OBSTACLE(motion->axis), number("", {-1e6, 1e6}),
           "It turns about this axis, by the right-hand rule; auto: it goes along a direction.",
           automatic, of(MotionKind::sine)),
       key(OBSTACLE(motion->amplitude), number("m or degrees", {-1e9, 1e9}),
           "Largest way, m, or angle, degrees.", required, of(MotionKind::sine)),
       key(OBSTACLE(motion->period), number("s", kSeconds), "Period.", required,
           of(MotionKind::sine)),
       key(OBSTACLE(motion->phase), number("degrees", kDegrees), kPhase, of(MotionKind::sine)),
       key(OBSTACLE(motion->ramp), number("s", {0, 1e9}), kRamp, of(MotionKind::sine)),
       key(OBSTACLE(motion->velocity), number("m/s", kRate), "Velocity of the pivot.",
           of(MotionKind::velocity), flat(FlatY::zero)),
       key(OBSTACLE(motion->angular), number("degrees/s", kDegrees),
           "It turns about this vector, by the right-hand rule, at the rate of its length.",
           of(MotionKind::velocity)),
       key(OBSTACLE(motion->path), plain,
           "CSV file, relative to the scene file, with the header t,x,y,z or t,x,y,z,rx,ry,rz: s, "
           "the way of the pivot in m, and degrees about x, then y, then z. Between rows cubic.",
           required, of(MotionKind::file), names_file),
       key(OBSTACLE(motion->pivot), number("m", kCoordinate),
           "The point about which it turns, before it moves; auto: the middle of the obstacle.",
           automatic, flat(FlatY::middle)),
       key(KEY(tank_motion->kind), one_of({"sine", "file"}), "sine: to and fro. file: a table.",
           required, is_kind),
       key(KEY(tank_motion->direction), number("", {-1e6, 1e6}),
           "The tank goes along this direction; auto: it turns about an axis.", automatic,
           of(TankMotionKind::sine), flat(FlatY::zero)),
       key(KEY(tank_motion->axis), number("", {-1e6, 1e6}),
           "The tank turns about this axis, by the right-hand rule; auto: it does not.", automatic),
       key(KEY(tank_motion->amplitude), number("m or degrees", {-1e9, 1e9}),
           "Largest way, m, or angle, degrees.", required, of(TankMotionKind::sine)),
       key(KEY(tank_motion->period), number("s", kSeconds), "Period.", required,
           of(TankMotionKind::sine)),
       key(KEY(tank_motion->phase), number("degrees", kDegrees), kPhase, of(TankMotionKind::sine)),
       key(KEY(tank_motion->ramp), number("s", {0, 1e9}), kRamp, of(TankMotionKind::sine)),
       key(KEY(tank_motion->path), plain,
           "CSV file, relative to the scene file, with the header t,angle (s, degrees about the "
           "axis; between rows cubic) or t,ax,ay,az (m/s^2, the acceleration of the tank; between "
           "rows linear).",
           required, of(TankMotionKind::file), names_file),
       key(KEY(tank_motion->pivot), number("m", kCoordinate),
           "The point about which the tank turns; auto: the middle of the domain.", automatic,
           flat(FlatY::middle))}};
}

}  // namespace pbf::inline scene_module
