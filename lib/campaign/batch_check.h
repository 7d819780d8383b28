// Checks every run of a batch before the first one starts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/campaign/batch_list.h"

namespace pbf::campaign_module {

/// The needs of the most demanding run of a batch, as `pbf plan` forecasts them.
struct BatchNeeds {
  std::int64_t host_bytes = 0;  ///< peak of one run
  bool device = false;          ///< whether a run uses a device
};

/// Reads and plans every run, with `overrides` (key.path=value) applied before its own;
/// `base_folder` as in load_scene(). `here`: every run must fit into the memory of this machine. If
/// runs cannot run, throws Error with the code of the first, naming up to ten of them with their
/// messages.
BatchNeeds check_members(const std::vector<BatchMember>& members,
                         const std::vector<std::string>& overrides, const std::string& base_folder,
                         bool here);

}  // namespace pbf::campaign_module
