// The kinds of gauges, in the order of their names in scenes; an include and a name each. Included
// twice, because a kind has two files: lib/scene/gauges/NAME.h for its description in scenes, and
// lib/program/gauges/NAME.h for its readings. PBF_GAUGE_FILE(name) selects one.
#include PBF_GAUGE_FILE(level)
#include PBF_GAUGE_FILE(velocity)
#include PBF_GAUGE_FILE(flow)
#include PBF_GAUGE_FILE(pressure)
#undef PBF_GAUGE_FILE
#undef PBF_GAUGES
#define PBF_GAUGES Level, Velocity, Flow, Pressure
