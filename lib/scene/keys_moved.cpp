// Keys of prescribed motions: of obstacles, and of the tank.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)
#define OBSTACLE(member) MEMBER_OF(obstacles, Obstacle, member)

constexpr Range kDegrees{-1e9, 1e9};
constexpr const char* kRamp =
    "Time in which the amplitude grows from 0 to its full value, as (1 - cos(pi t/ramp))/2. 0: no "
    "ramp. auto: none for a sine, of waves the period, two of irregular ones.";
constexpr const char* kPhase =
    "Phase of the sine at t = 0; of focused waves that at their place and time, 180 for a trough.";
constexpr auto kRegular = MotionKind::regular_waves, kIrregular = MotionKind::irregular_waves,
               kSolitary = MotionKind::solitary_waves, kFocused = MotionKind::focused_waves;

/// Further keys of wave makers.
std::vector<Key> wave_keys() {
  const auto of_waves = of(kRegular, kIrregular, kSolitary, kFocused);
  const auto of_spectra = of(kIrregular, kFocused);
  return {
      key(OBSTACLE(motion->height), number("m", kLength),
          "Height of the waves: of regular ones from trough to crest, of irregular ones the "
          "significant one, 4 sqrt(m0).",
          required, of(kRegular, kIrregular)),
      key(OBSTACLE(motion->order), number("", {0, 2}),
          "Order of the theory: with 1 a free wave of half the period runs along. auto: 2 of a "
          "piston, 1 of a flap.",
          automatic, of(kRegular), exact("a choice")),
      key(OBSTACLE(motion->depth), number("m", kLength),
          "Depth of still water; auto: that to which blocks on the floor are filled.", automatic,
          of_waves),
      key(OBSTACLE(motion->gain), number("", {0, 100}),
          "Factor on the motion; the expected elevation is that of 1.", of_waves),
      key(OBSTACLE(motion->start), number("s", {0, 1e9}), "When the motion begins.", of_waves),
      key(OBSTACLE(motion->breaking), plain,
          "on: waves that break before they leave the paddle are meant.", of(kRegular, kSolitary)),
      key(OBSTACLE(motion->spectrum), one_of({"jonswap", "pierson_moskowitz"}),
          "Spectrum of the waves, with its peak at 1/period.", of_spectra),
      key(OBSTACLE(motion->gamma), number("", {1, 20}),
          "Factor of the peak of jonswap; pierson_moskowitz has none.", of_spectra),
      key(OBSTACLE(motion->band), number("", {0.05, 20}),
          "Lowest and highest frequency of the lines, in 1/period; they hold all the energy. auto: "
          "[0.4, 3].",
          automatic, of_spectra),
      key(OBSTACLE(motion->seed), number("", {0, 9223372036854775807.0}),
          "Seed of the phases; the phase of a line depends on the seed and its number alone.",
          of(kIrregular)),
      key(OBSTACLE(motion->repeat), number("s", kSeconds),
          "Time after which the waves repeat: lines are 1/repeat apart. auto: the run from start "
          "on, rounded up to whole seconds, at least 4 periods.",
          automatic, of(kIrregular)),
      key(OBSTACLE(motion->amplitudes), one_of({"spectrum", "random"}),
          "Amplitudes of the lines. spectrum: exactly those of the spectrum. random: both parts "
          "from a Gaussian, as at sea, so that the height of a record scatters.",
          of(kIrregular)),
      key(OBSTACLE(motion->theory), one_of({"rayleigh", "boussinesq"}),
          "Theory of the solitary wave, whose length it decides.", of(kSolitary)),
      [] {
        Key row = key(OBSTACLE(motion->heights), number("m", kLength),
                      "Heights of the waves in their order, [0.06].", required, of(kSolitary));
        row.most = 100;
        return row;
      }(),
      [] {
        Key row = key(OBSTACLE(motion->times), number("s", {0, 1e9}),
                      "When the paddle begins each wave, after start.", of(kSolitary));
        row.most = 100;
        return row;
      }(),
      key(OBSTACLE(motion->crest), number("m", kLength),
          "Elevation at the place and time of focus, by linear theory.", required, of(kFocused)),
      key(OBSTACLE(motion->place), number("m", kCoordinate),
          "Coordinate of the focus along the direction of the waves.", required, of(kFocused)),
      key(OBSTACLE(motion->time), number("s", kSeconds), "Time of the focus, after start.",
          required, of(kFocused)),
      key(OBSTACLE(motion->components), number("", {1, 4096}),
          "Number of lines of the band, at equal distances.", of(kFocused), exact("a number"))};
}

KeyRows moved_rows() {
  KeyRows rows{
      {optional_block(
           OBSTACLE(motion),
           "Moves the obstacle from where its other keys put it, as a function of time."),
       optional_block(KEY(tank_motion),
                      "Moves the tank. All coordinates, velocities and loads are in the frame of "
                      "the tank, where the fluid feels the fictitious forces.")},
      {key(OBSTACLE(motion->kind),
           one_of({"sine", "velocity", "file", "regular_waves", "irregular_waves", "solitary_waves",
                   "focused_waves"}),
           "sine: oscillation. velocity: constant velocity and rotation. file: a table of "
           "positions and angles. The others: a wave maker, a box that moves as theory says.",
           required, is_kind),
       key(OBSTACLE(motion->direction), number("", {-1e6, 1e6}),
           "Direction of an oscillation along a line, and of the waves of a piston; auto: it "
           "rotates about an axis.",
           automatic, of(MotionKind::sine, kRegular, kIrregular, kSolitary, kFocused),
           flat(FlatY::zero)),
       key(OBSTACLE(motion->axis), number("", {-1e6, 1e6}),
           "Axis of an oscillation by rotation (right-hand rule), of a flap whose waves run along "
           "x that is [0, 1, 0]; auto: it moves along a direction.",
           automatic, of(MotionKind::sine, kRegular, kIrregular, kFocused)),
       key(OBSTACLE(motion->amplitude), number("m or degrees", {-1e9, 1e9}),
           "Amplitude: a length along the direction, or an angle about the axis.", required,
           of(MotionKind::sine)),
       key(OBSTACLE(motion->period), number("s", kSeconds),
           "Period; of irregular and focused waves that of the peak of the spectrum.", required,
           of(MotionKind::sine, kRegular, kIrregular, kFocused)),
       key(OBSTACLE(motion->phase), number("degrees", kDegrees), kPhase,
           of(MotionKind::sine, kFocused)),
       key(OBSTACLE(motion->ramp), number("s", {0, 1e9}), kRamp, automatic,
           of(MotionKind::sine, kRegular, kIrregular, kFocused)),
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
       key(KEY(tank_motion->phase), number("degrees", kDegrees), "Phase of the sine at t = 0.",
           of(TankMotionKind::sine)),
       key(KEY(tank_motion->ramp), number("s", {0, 1e9}),
           "Time in which the amplitude grows, as that of obstacles. auto: none.", automatic,
           of(TankMotionKind::sine)),
       key(KEY(tank_motion->path), plain,
           "CSV file, relative to the scene file, with the header t,angle (s, degrees about the "
           "axis; cubic between rows) or t,ax,ay,az (m/s^2, acceleration of the tank; linear "
           "between rows).",
           required, of(TankMotionKind::file), names_file),
       key(KEY(tank_motion->pivot), number("m", kCoordinate),
           "The point about which the tank rotates; auto: the middle of the domain.", automatic,
           flat(FlatY::middle))}};
  const auto behind = std::ranges::find(rows.keys, "obstacles[].motion.velocity", &Key::path);
  const std::vector<Key> more = wave_keys();
  rows.keys.insert(behind, more.begin(), more.end());
  return rows;
}

}  // namespace pbf::scene_module
