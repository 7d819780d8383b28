// Keys of obstacles and gauges: those of every one, and those of their shapes and kinds.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define KEY(member) MEMBER(Scene, member)
#define OBSTACLE(member) MEMBER_OF(obstacles, Obstacle, member)

KeyRows obstacle_rows() {
  KeyRows all{
      {list_block(KEY(obstacles), "Solids that the fluid flows around",
                  {.entry_name = "obstacle",
                   .remark = "particles of bodies in them are left out",
                   .example = "{name: block, shape: box, min: [0.4, 0.4, 0], max: [0.6, 0.6, 0.3]}",
                   .further = "{name: ball, shape: sphere, center: [0.5, 0.5, 0.5], radius: 0.1, "
                              "loads: true}"},
                  exact("all solvers of a comparison have the same solids"))},
      {key(OBSTACLE(name), plain, "Name, in the columns of the log.", required),
       kind_row("obstacles[].shape",
                "Shape of the obstacle; decides which keys it has. With dimensions: 2 y does not "
                "count, and a sphere is a disc.",
                &Obstacle::shape)}};
  for (const bool bounded : {true, false})  // pages list bounded shapes before planes
    add_kind_rows(all.keys, "obstacles[]", &Obstacle::shape, [&]<class Shape>(const Shape&) {
      return requires { Shape::Body::endless; }
      != bounded;
    });
  all.keys.push_back(key(OBSTACLE(friction), number("", {0, 1}),
                         "Friction of its surface, as domain.friction of walls: 0 slides, 1 does "
                         "not slip. An obstacle that moves takes the fluid along.",
                         off_at(0)));
  all.keys.push_back(key(OBSTACLE(loads), plain,
                         "Sums the force and the torque of the fluid on it; columns "
                         "load/NAME/force_x and so on of the log."));
  return all;
}

KeyRows gauge_rows() {
  std::string help = "What is read; decides which keys it has.";
  for_each_kind<gauge_keys::Any>([&](const auto& kind) {
    help.append(" ").append(kind.word).append(": ").append(kind.about).append(".");
  });
  KeyRows all{{list_block(KEY(gauges), "Gauges, read every output.gauges_every",
                          {.entry_name = "gauge",
                           .remark = "in /pbf/gauges of run.vtkhdf",
                           .example = "{name: H1, kind: level, at: [0.5, 0.5]}",
                           .further = "{name: H1, kind: level, at: [0.5, 0.2]}"},
                          exact("all solvers of a comparison have the same gauges"))},
              {key(MEMBER_OF(gauges, Gauge, name), plain, "Name, in the run file.", required),
               kind_row("gauges[].kind", help, &Gauge::kind)}};
  add_kind_rows(all.keys, "gauges[]", &Gauge::kind, [](const auto&) { return true; });
  return all;
}

}  // namespace pbf::scene_module
