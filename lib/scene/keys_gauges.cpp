// Keys of gauges: those of every one, and those of their kinds.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

KeyRows gauge_rows() {
  std::string help = "What is read; decides which keys it has.";
  for_each_kind<gauge_keys::Any>([&](const auto& kind) {
    help.append(" ").append(kind.word).append(": ").append(kind.about).append(".");
  });
  KeyRows all{{list_block(MEMBER(Scene, gauges), "Gauges, read every output.gauges_every",
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
