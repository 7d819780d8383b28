// Keys of comparisons with measurements.
#include "lib/scene/key_rows.h"

namespace pbf::scene_module {

#define OF(member) MEMBER_OF(compare, Comparison, member)

KeyRows compare_rows() {
  return {
      {list_block(MEMBER(Scene, compare), "Readings beside measurements or a reference run",
                  {.entry_name = "comparison",
                   .remark = "in the summary and /pbf/compare of run.vtkhdf",
                   .example = "{gauge: H2, data: heights.csv, column: H2_mm}",
                   .further = ""},
                  effect(Effect::none), exact("no step computes with what is compared"))},
      {key(OF(name), plain,
           "Name of the result. Empty: the reading's, such as H2, U_x, post_x, front_x."),
       key(OF(gauge), plain,
           "The gauge that is compared. One of gauge, load and log says which reading it is."),
       key(OF(load), plain, "The wall or obstacle whose load is compared (loads: true)."),
       key(OF(log), plain, "The column of the log that is compared: front_x, load/post/torque_y."),
       key(OF(component), plain,
           "x, y or z of a velocity or of the force of a load; of a load also torque_x ... and "
           "force_peak."),
       key(OF(data), plain,
           "CSV table with a column of times, or another run (its folder or run.vtkhdf). Relative "
           "to the scene file.",
           required, names_file),
       key(OF(column), plain,
           "Column of the table, or reading of the other run. Empty: named as the reading, with a "
           "unit at its end (H2_mm). Known units: _s _ms _m _cm _mm _m_s _Pa _kPa _N _kN _kg_s and "
           "so on."),
       key(OF(time_column), plain, "Its column of times. Empty: the first named t or time (t_ms)."),
       key(OF(time_scale), number("s", {1e-12, 1e12}),
           "Seconds of one unit of the times; auto: from the column's name.", automatic),
       key(OF(scale), number("", {-1e30, 1e30}),
           "The column times scale plus offset is the measured value; auto: from the unit in the "
           "column's name.",
           automatic),
       key(OF(offset), number("", kCoordinate), "In the unit of the reading."),
       key(OF(average), number("s", {0, 1e9}),
           "Window over which both are averaged about each measured time; 0: none."),
       key(OF(between), number("s", kRate), "The measured times that count, [from, to]; auto: all.",
           automatic),
       key(OF(lag), plain,
           "By how much the run is late: none; a number of seconds; fit, the one of largest "
           "correlation; or the name of another comparison, for the lag fitted there."),
       key(OF(lag_range), number("s", kRate), "Of lag: fit, [least, largest].", automatic),
       key(OF(threshold), number("", kRate),
           "The first time it is reached is the arrival. auto: a tenth of the way from the first "
           "measured value to the peak.",
           automatic)}};
}

}  // namespace pbf::scene_module
