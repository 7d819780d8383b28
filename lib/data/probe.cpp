#include "lib/data/probe.h"

#include <algorithm>
#include <cmath>

#include "lib/base/error.h"
#include "lib/data/units.h"
#include "lib/program/obstacles.h"
#include "lib/program/plan.h"
#include "lib/scene/keys.h"
#include "lib/scene/load.h"
#include "lib/scene/scene_text.h"
#include "lib/scene/validate.h"

namespace pbf::data_module {
namespace {

/// Made by a pass over the particles at a reading.
template <class Tally>
constexpr bool kReadByPass = requires {
  Tally::sums;
};
template <class Tally>
constexpr bool kReadFromFrames = kReadByPass<Tally> || std::is_same_v<Tally, FlowTally>;

void refuse_others(const Scene& scene, const Node& gauges) {
  for (std::size_t k = 0; k < scene.gauges.size(); ++k)
    std::visit(
        [&]<class Keys>(const Keys&) {
          if constexpr (!kReadFromFrames<typename Keys::Tally>)
            bad_input(gauges.items[k].place() + ": gauges[" + std::to_string(k) + "]",
                      std::string("a ") + Keys::word +
                          " comes from what the iterations of an update did (their multipliers), "
                          "as loads do, and no frame holds that; put the gauge into the scene and "
                          "run it again");
        },
        scene.gauges[k].kind);
}

/// The gauges of a plan on one frame after another.
class FrameGauges {
 public:
  FrameGauges(const Scene& scene, const Plan& plan) : s_(scene), plan_(plan) {
    const auto resize = [&]<class Tally>(TallySums<Tally>& sums) {
      sums.rows.resize(std::size_t(plan.gauges.of<Tally>().sums));
    };
    std::apply([&](auto&... sums) { (resize(sums), ...); }, sums_);
  }

  /// The numbers of a reading.
  std::vector<double> read(const Snapshot& frame) {
    take_particles(frame);
    std::apply([&](auto&... sums) { (add(sums, frame), ...); }, sums_);
    std::vector<double> numbers = plan_.gauges.finish(sums_);
    for (FlowCount& count : std::get<TallySums<FlowTally>>(sums_).rows) count.since = 0;
    return numbers;
  }

 private:
  void take_particles(const Snapshot& frame) {
    const FieldArray &at = *frame.find("position"), *v = frame.find("velocity");
    position_.resize(frame.count), velocity_.resize(v ? frame.count : 0);
    const auto vector = [](const FieldArray& f, std::size_t i) {
      return Double3{f.number(3 * i), f.number(3 * i + 1), f.number(3 * i + 2)};
    };
    for (std::size_t i = 0; i < frame.count; ++i) {
      position_[i] = with_w(internal_place(s_, plan_.axes, vector(at, i)), 0.0);
      if (v) velocity_[i] = with_w((1 / s_.h()) * along_internal(plan_.axes, vector(*v, i)), 0.0);
    }
  }

  template <class Tally>
  void add(TallySums<Tally>& sums, const Snapshot& frame) {
    const auto& of = plan_.gauges.of<Tally>();
    if constexpr (kReadByPass<Tally>) {
      std::ranges::fill(sums.rows, typename Tally::Sums{});
      const auto pass = gauge_pass(of.sites.data(), int(of.sites.size()), position_.data(),
                                   velocity_.data(), s_.time.step, sums.rows.data());
      for (int i = 0; i < int(frame.count); ++i) pass(i);
    } else if constexpr (std::is_same_v<Tally, FlowTally>) {
      if (!of.sites.empty()) count_flow(of.sites, sums.rows, frame);
    }
  }

  /// Rows stand for ids, as the pass wants small ones.
  void count_flow(const std::vector<FlowGate>& gates, std::vector<FlowCount>& counts,
                  const Snapshot& frame) {
    const std::vector<std::int64_t> ids = ids_of(frame);
    std::vector<int> rows(frame.count), sides(frame.count);
    for (std::size_t i = 0; i < frame.count; ++i) rows[i] = int(i);
    FlowPass<double> pass{gates.data(),
                          int(gates.size()),
                          OwnRows<const Vec4<double>>(position_.data()),
                          OwnRows<const int>(rows.data()),
                          sides.data(),
                          nullptr,
                          0};
    for (std::size_t i = 0, before = 0; i < frame.count; ++i) {
      while (before < ids_.size() && ids_[before] < ids[i]) ++before;
      if (before < ids_.size() && ids_[before] == ids[i])
        sides[i] = sides_[before];
      else
        pass(int(i));  // it has appeared
    }
    pass.count = counts.data();
    for (int i = 0; i < int(frame.count); ++i) pass(i);
    for (FlowCount& count : counts) count.time = std::isnan(time_) ? 0 : frame.time - time_;
    time_ = frame.time, ids_ = ids, sides_ = std::move(sides);
  }

  const Scene& s_;
  const Plan& plan_;
  GaugeSums sums_;
  std::vector<Vec4<double>> position_, velocity_;
  // Of the frame before, for flows.
  double time_ = NAN;
  std::vector<std::int64_t> ids_;
  std::vector<int> sides_;
};

/// H_m, U_x_m_s, Q_total_kg.
std::string column_name(const ReadingColumn& c, int component) {
  std::string name = c.of;
  if (*c.name) name += std::string("_") + c.name;
  if (c.components > 1) name += std::string("_") + "xyz"[component];
  return name + unit_ending(c.unit);
}

void require_frames(const RunReader& file, const Scene& scene) {
  const auto fields = file.fields();
  for (const Gauge& g : scene.gauges)
    std::visit(
        [&]<class Keys>(const Keys&) {
          const std::string gauge = "gauge " + g.name + " reads a " + Keys::word;
          if (std::is_same_v<typename Keys::Tally, FlowTally> && file.frames() < 2)
            throw Error(ExitCode::bad_input, gauge + " between two frames, and the run has " +
                                                 std::to_string(file.frames()) +
                                                 "; run the scene with a shorter output.every");
          if (std::is_same_v<Keys, gauge_keys::Velocity> &&
              std::ranges::find(fields, "velocity") == fields.end())
            throw Error(ExitCode::bad_input,
                        gauge +
                            ", and the frames of the run have none; run the scene with "
                            "output.fields: [velocity]");
        },
        g.kind);
  if (file.frames() == 0)
    throw Error(ExitCode::bad_input, "the run has no frames yet; gauges are read on frames");
}

}  // namespace

Scene scene_with_gauges(const RunInfo& info, const std::string& path, const std::string& gauges) {
  const Node given = load_tree(gauges, "gauges");
  constexpr const char* kForm = "; give gauges alone: gauges: [{name: H, kind: level, at: [1]}]";
  if (given.kind != Node::Kind::map)
    bad_input(given.place(), "is " + given.shown() + ", no file of gauges" + kForm);
  for (const Node& key : given.keys) {
    if (key.text != "gauges")
      bad_input(key.place() + ": " + key.text, std::string("does not belong here") + kForm);
    if (&key != given.keys.data())
      bad_input(key.place() + ": " + key.text,
                "given twice, first at " + given.keys[0].place() + "; remove one");
  }
  const Node* list = given.find("gauges");
  if (list && list->kind != Node::Kind::list)
    bad_input(list->place() + ": gauges", "is " + list->shown() + ", expected a list" + kForm);
  if (!list || list->items.empty())
    bad_input((list ? *list : given).place() + ": gauges", std::string("has no gauge") + kForm);
  Node root = tree_of_text(info.resolved_scene, path + ": its scene", "scene");
  use_new_names(scene_table(), root);
  // `capacity` limits what a flow gauge of a run follows.
  for (const char* key : {"gauges", "compare", "summary", "capacity"}) root.erase(key);
  root.append(given.keys[0], *list);
  Problems problems;
  const Scene scene = scene_of_tree(root, problems);
  problems.raise();
  refuse_others(scene, *list);
  return scene;
}

Probed probe(const RunReader& file, const Scene& scene) {
  require_frames(file, scene);
  make_maps(scene);
  const Plan plan = make_plan(scene, file.info().particles);
  std::vector<std::string> names{"time_s"};
  std::string units = "time_s=s";
  for_each_number(plan.gauges.columns, Series::gauges, [&](const ReadingColumn& c, int k, auto) {
    names.push_back(column_name(c, k));
    units += ", " + names.back() + "=" + c.unit;
  });
  Table table(names);
  FrameGauges gauges(scene, plan);
  for (std::int64_t k = 0; k < file.frames(); ++k) {
    const Snapshot frame = file.frame(k);
    const std::vector<double> numbers = gauges.read(frame);
    std::vector<Cell> row{frame.time};
    for_each_number(plan.gauges.columns, Series::gauges,
                    [&](const ReadingColumn& c, int, std::size_t n) {
                      row.push_back(k == 0 && c.join == Join::mean ? Cell{} : known(numbers[n]));
                    });
    table.add(row);
  }
  return {table, units};
}

}  // namespace pbf::data_module
