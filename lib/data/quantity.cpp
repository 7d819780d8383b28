#include "lib/data/quantity.h"

#include <cmath>
#include <map>
#include <memory>

#include "lib/base/error.h"
#include "lib/base/text.h"
#include "lib/io/run_layout.h"
#include "lib/scene/difference.h"
#include "lib/scene/gauge.h"
#include "lib/scene/suggest.h"

namespace pbf::data_module {
namespace {

const std::string kGauge = "gauges/", kLog = "log/";

/// Whether a gauge of that kind reads means over the interval between two readings.
bool reads_means(const std::string& kind) {
  bool means = false;
  for_each_kind<gauge_keys::Any>([&](const auto& keys) {
    if (kind == keys.word) means = keys.columns[0].join == Join::mean;
  });
  return means;
}

/// Loads are means, their peaks are not.
bool load_means(const std::string& path) {
  return path.starts_with("log/load/") && !path.ends_with("_peak") &&
         path.find("/impulse_", path.rfind('/')) == path.npos;
}

/// With _ for /, as columns of tables are named.
std::string flat_name(std::string name) {
  for (char& c : name)
    if (c == '/') c = '_';
  return name;
}

}  // namespace

Readings readings_of(const std::vector<ReadingColumn>& columns, bool work) {
  const auto all = std::make_shared<std::map<std::string, ReadingSite>>();
  for (const auto& c : run_layout::log_columns()) (*all)[kLog + c.name] = {c.unit};
  if (work) (*all)[kLog + "work"] = {"J"};
  for (const ReadingColumn& c : columns) {
    const bool means = c.join == Join::mean;
    if (c.series == Series::gauges) {
      (*all)[kGauge + (*c.name ? std::string(c.name) + "/" : "") + c.of] = {c.unit, c.components,
                                                                            means};
      continue;
    }
    for (int k = 0; k < c.components; ++k)
      (*all)[kLog + run_layout::further_column(c, k)] = {c.unit, 1, means};
  }
  return {[all](const std::string& path) {
            const auto at = all->find(path);
            return at == all->end() ? std::nullopt : std::optional(at->second);
          },
          [all] {
            std::vector<std::string> names;
            for (const auto& [path, site] : *all) names.push_back(path);
            return names;
          }};
}

Readings readings_of(const RunReader& file) {
  return {[&file](const std::string& path) -> std::optional<ReadingSite> {
            if (!path.starts_with(kGauge) && !path.starts_with(kLog)) return std::nullopt;
            const RunColumn c = file.column(path);
            if (c.values.empty()) return std::nullopt;
            const bool first = path.find('/', kGauge.size()) == path.npos;  // not total/Q, peak/P
            return ReadingSite{c.unit, c.components,
                               (first && reads_means(c.kind)) || load_means(path)};
          },
          [&file] {
            std::vector<std::string> names;
            for (const std::string& name : file.gauges())
              if (name != "time" && name != "update") names.push_back(kGauge + name);
            for (const std::string& name : file.log_columns()) names.push_back(kLog + name);
            return names;
          }};
}

std::string key_word(const Comparison& entry, const std::string& key) {
  if (!by_options(entry)) return key;
  std::string word = "--" + key;
  std::ranges::replace(word, '_', '-');
  return word;
}

Quantity quantity_of(const Comparison& c, const Readings& readings, const std::string& key) {
  Quantity q;
  if (!c.gauge.empty()) {
    q.path = kGauge + c.gauge;
    q.names = {flat_name(c.gauge)};
  } else if (!c.load.empty()) {
    const bool force = c.component.size() == 1;
    q.path = kLog + "load/" + c.load + "/" + (force ? "force_" : "") + c.component;
    for (const std::string& of : {c.load, "load_" + c.load}) {
      q.names.push_back(of + "_" + c.component);
      if (force) q.names.push_back(of + "_force_" + c.component);
      if (c.component == "force_peak") q.names.push_back(of + "_peak");
    }
  } else {
    q.path = kLog + c.log;
    q.names = {flat_name(c.log)};
  }
  const std::optional<ReadingSite> site = readings.find(q.path);
  if (!site) {
    std::vector<std::string> words;
    const std::string of = q.path.substr(0, q.path.find('/') + 1);
    for (const std::string& path : readings.names())
      if (path.starts_with(of)) words.push_back(path.substr(of.size()));
    const std::string wanted = q.path.substr(of.size()), near = nearest_word(wanted, words);
    bad_input(key, (of == kGauge ? "no gauge is named " : "the log has no column ") + wanted +
                       (words.empty()  ? "; the run has none"
                        : near.empty() ? "; there are " + first_of(words)
                                       : "; did you mean " + near + "?"));
  }
  q.site = *site;
  if (q.site.components == 1 && !c.gauge.empty() && !c.component.empty())
    bad_input(key, c.gauge + " reads one number; leave out the component " + c.component);
  const std::size_t axis = std::string("xyz").find(c.component);
  if (q.site.components > 1 && (c.component.size() != 1 || axis == std::string::npos))
    bad_input(key, c.gauge + " reads a vector; give component: x, y or z");
  if (q.site.components > 1) {
    q.component = int(axis);
    q.names[0] += "_" + c.component;
  }
  return q;
}

QuantitySeries read_quantity(const RunReader& file, const Quantity& q) {
  return series_of(file.column(q.path), file.column(time_path(q.path)), q);
}

QuantitySeries series_of(const RunColumn& own, const RunColumn& time, const Quantity& q) {
  QuantitySeries out;
  out.time = time.values;
  for (std::size_t k = 0; k < out.time.size(); ++k) {
    const std::size_t at = k * std::size_t(own.components) + std::size_t(q.component);
    if (at >= own.values.size()) break;
    out.value.push_back(own.values[at]);
  }
  out.time.resize(out.value.size());
  return without_start(std::move(out), q);
}

std::string time_path(const std::string& path) { return path.substr(0, path.find('/')) + "/time"; }

QuantitySeries without_start(QuantitySeries series, const Quantity& q) {
  // A mean over no time is stored as 0.
  if (q.site.means && !series.value.empty()) series.value[0] = NAN;
  return series;
}

}  // namespace pbf::data_module
