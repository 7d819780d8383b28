// What the files of the runs of a batch say at their ends.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lib/base/worker.h"
#include "lib/campaign/batch_list.h"
#include "lib/io/table.h"
#include "lib/scene/scene.h"

namespace pbf::campaign_module {

/// A column that not every run has.
struct NamedNumber {
  std::string name, unit;
  double value = 0;  ///< NaN: there is none
};

/// What a run file says; all empty if there is none, or it cannot be read: the message of the run
/// tells why.
struct FileResults {
  std::vector<Cell> cells;            ///< of file_columns()
  std::vector<NamedNumber> readings;  ///< gauges and loads
  std::vector<NamedNumber> compared;  ///< with measurements: "compare/H2/rms"
  bool named = false;                 ///< its scene says which readings
  bool too_many = false;              ///< it does not, and they are too many
};

/// Last measurements; numbers of particles, frames and warnings; seconds.
std::vector<std::string> file_columns();

/// The scene of a member as it is now. Throws Error.
using SceneOfMember = std::function<Scene(const BatchMember&)>;

/// Reads the files of runs while others are under way, on a thread of its own: reading those of 64
/// small runs takes a second, a quarter of the time of the batch.
class RunResults {
 public:
  /// out: the folder of the run folders. scene_now: says which gauges and loads are wanted; where
  /// it throws, the scene of the run does. Throws Error(unavailable) if no thread can be started.
  RunResults(std::string out, SceneOfMember scene_now)
      : out_(std::move(out)), scene_now_(std::move(scene_now)) {}
  /// A run that has ended: its files do not change any more.
  void read(const BatchMember& m);
  /// Of all these. Reads the files of those that have not ended, too.
  std::vector<FileResults> of(const std::vector<BatchMember>& members);

 private:
  const std::string out_;
  const SceneOfMember scene_now_;
  std::map<std::string, FileResults> read_;  // by name; the worker's
  Worker worker_{1};                         // last: its jobs use the rest
};

}  // namespace pbf::campaign_module
