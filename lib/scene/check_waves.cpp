// Rules for wave makers.
#include "lib/scene/scene_rules.h"
#include "lib/scene/waves.h"

namespace pbf::scene_module {
namespace {

class WaveChecker : public SceneRules {
 public:
  using SceneRules::SceneRules;

  void run() {
    for (const Obstacle& o : s_.obstacles)
      if (o.motion && good(o.motion->kind) && makes_waves(*o.motion) && stands(o)) check(o);
  }

 private:
  static constexpr double kMostLines = 1e5;
  static constexpr double kMostSines = 2e9;  ///< half a minute

  template <class... T>
  bool fail(const auto& member, fmt::format_string<Shown<T>...> text, const T&... values) {
    add(member, text, values...);
    return false;
  }
  std::string block(const Motion& m) const { return block_of(name(m.kind)); }

  /// Whether its box, direction and tank are as wave makers need them.
  bool stands(const Obstacle& o) {
    const Motion& m = *o.motion;
    if (!good(m.direction, m.axis, m.pivot, s_.gravity, s_.domain.min, s_.domain.max) ||
        !good_obstacle(o))
      return false;
    if (bool(m.direction) == bool(m.axis)) {
      add_at(block(m),
             "a wave maker needs direction, which makes it a piston, or axis and pivot of a flap"
             "{}; give one",
             m.axis ? ", not both" : "");
      return false;
    }
    const Double3& along = m.direction ? *m.direction : *m.axis;
    if (along[2] != 0 || (along[0] != 0) == (along[1] != 0)) {
      const char* kRemedy =
          "waves run along x or y; give [1, 0, 0] or [0, 1, 0], negative for the "
          "other way";
      if (m.direction) return fail(m.direction, "{}", kRemedy);
      return fail(m.axis, "{}", kRemedy);
    }
    if (m.direction) {
      if (flat() && along[1] != 0) return must_lie_flat(m.direction, along), false;
      if (m.pivot)
        return fail(m.pivot,
                    "is the hinge of a flap, and direction makes a piston; remove one of them");
    } else {
      if (flat() && along[0] != 0)
        return fail(m.axis, "with dimensions: 2 nothing turns but about y; give [0, 1, 0]");
      if (!m.pivot) {
        add_at(block(m), "a flap needs pivot, a point of its hinge; give one");
        return false;
      }
      if (good(m.order) && m.order == 2)
        return fail(m.order, "2 is known of pistons alone; give 1, or a direction");
    }
    if (!std::holds_alternative<obstacle_keys::Box>(o.shape))
      return fail(o.shape,
                  "a wave maker is a box; give that, or its motion as a table (kind: file)");
    if (s_.gravity[0] != 0 || s_.gravity[1] != 0 || !(s_.gravity[2] < 0) ||
        !s_.domain.has_wall(2, false)) {
      add_at(block(m), "waves need gravity along -z, and the wall z_min below; give them");
      return false;
    }
    return true;
  }

  bool keys_agree(const Motion& m) {
    if (!good(m.height, m.period, m.depth, m.gain, m.start, m.ramp, m.gamma, m.band, m.repeat,
              m.heights, m.times, m.crest, m.place, m.time, m.components))
      return false;
    if (m.band && !((*m.band)[0] < (*m.band)[1]))
      return fail(m.band, "its lowest frequency {} is not below its highest, {}; give [0.4, 3]",
                  (*m.band)[0], (*m.band)[1]);
    if (m.kind == MotionKind::irregular_waves || m.kind == MotionKind::focused_waves) {
      const auto [low, high] = m.band.value_or(std::array{0.4, 3.0});
      if (!(wave_spectrum(std::clamp(1.0, low, high), 1) > 1e-200))
        return fail(m.band, "holds no energy of the spectrum, whose peak is at 1; give [0.4, 3]");
    }
    if (m.heights.size() != m.times.size() && m.kind == MotionKind::solitary_waves)
      return fail(m.times, "has {} numbers, heights has {}; give one of each wave", m.times.size(),
                  m.heights.size());
    if (!std::ranges::is_sorted(m.times)) return fail(m.times, "must ascend");
    if (m.kind == MotionKind::irregular_waves) {
      const auto [low, high] = m.band.value_or(std::array{0.4, 3.0});
      const double unit = repeat_of(s_, m) / m.period,
                   lines = std::floor(high * unit) - std::ceil(low * unit) + 1;
      if (!(lines >= 1 && lines <= kMostLines))
        return fail(m.repeat, "makes {} lines in the band, must be 1 to {}; give another",
                    std::max(0.0, lines), kMostLines);
      const double rows = good(s_.time.end) ? s_.time.end * kRowsPerPeriod * high / m.period : 0;
      if (lines * rows > kMostSines)
        return fail(m.repeat,
                    "makes {} lines, and the motion has {} rows: too many sines to add up. Give "
                    "{} s or less, after which the sea repeats",
                    lines, rounded(rows, 3),
                    std::floor(repeat_of(s_, m) * kMostSines / (lines * rows)));
    }
    return true;
  }

  bool blocks_are_good() const {
    return good(s_.fluid.spacing, s_.time.end, s_.time.motion_begin) &&
           std::ranges::all_of(s_.bodies, [&](const Body& b) {
             return good(b.shape) && (b.shape != Shape::block || good(b.min, b.max));
           });
  }
  bool has_depth(const Obstacle& o) {
    const Motion& m = *o.motion;
    const std::optional<FilledDepth> filled = filled_depth(s_, o);
    const double d = s_.fluid.spacing, level = filled ? filled->level : 0;
    if (!m.depth && !(level > 0))
      return fail(m.depth,
                  "auto is the level of blocks that stand on the floor ahead of it, and there are "
                  "none, or of different heights; give a number");
    if (m.depth && filled && std::fabs(*m.depth - level) > 0.5 * d * (1 + 1e-9))
      return fail(m.depth,
                  "is {} m, and the blocks are filled to {} m, in which long waves are {} % {}; "
                  "give auto, or blocks of this height and fluid.spacing {}, which fits",
                  *m.depth, rounded(level, 6),
                  rounded(100 * std::fabs(1 - std::sqrt(level / *m.depth)), 2),
                  level < *m.depth ? "slower" : "faster",
                  rounded(*m.depth / std::max(1.0, std::round(*m.depth / d))));
    const double depth = m.depth.value_or(level);
    if (m.pivot && !((*m.pivot)[2] - s_.domain.min[2] < depth))
      return fail(m.pivot, "is {} m above the floor, the water is {} m deep; give a hinge below",
                  rounded((*m.pivot)[2] - s_.domain.min[2], 6), rounded(depth, 6));
    return true;
  }

  void check_height(const WaveMaker& w, const Motion& m, const auto& member, double height) {
    const double d = s_.fluid.spacing;
    if (m.kind != MotionKind::irregular_waves && m.kind != MotionKind::focused_waves &&
        !m.breaking && height > w.breaks_at())
      add(member,
          "{} m is above {} m, at which waves break here ({}); lower it, or give breaking: true",
          height, rounded(w.breaks_at()),
          w.by_mccowan() ? "McCowan, 0.78 of the depth" : "Miche, 0.142 L tanh kD");
    if (height < 2 * d)
      add(member, "makes waves of {} spacings, which are lost; give fluid.spacing {} or less",
          rounded(height / d, 3), rounded(height / 5));
  }

  void check(const Obstacle& o) {
    const Motion& m = *o.motion;
    if (!keys_agree(m) || !blocks_are_good() || !has_depth(o)) return;
    const WaveMaker w = wave_maker(s_, o);
    if (m.kind == MotionKind::solitary_waves)
      check_height(w, m, m.heights, *std::ranges::max_element(m.heights));
    else if (m.kind == MotionKind::focused_waves)
      check_height(w, m, m.crest, w.height);
    else
      check_height(w, m, m.height, w.height);
    if (m.kind == MotionKind::focused_waves && !(w.sign * m.place > w.front))
      add(m.place, "is {}, and the paddle stands at {}; give a place ahead of it", m.place,
          w.sign * w.front);
  }
};

}  // namespace

void check_waves(const PlacedScene& placed, Problems& problems) {
  WaveChecker(placed, problems).run();
}

}  // namespace pbf::scene_module
