// A look at every run of a batch before the first one starts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lib/campaign/batch_list.h"

namespace pbf::inline campaign_module {

/// What the most demanding run of a batch needs, as `pbf plan` forecasts it.
struct BatchNeeds {
  std::int64_t host_bytes = 0;  ///< peak of a run
  bool device = false;          ///< a run is on one
};

/// Reads and plans every run, with `overrides` (key.path=value) before its own; `base_folder` as
/// in load_scene(). `here`: on this machine, whose memory must hold each of them. Throws Error,
/// with the code of the first one that cannot run, naming it and up to nine more, each with its
/// message.
BatchNeeds check_members(const std::vector<BatchMember>& members,
                         const std::vector<std::string>& overrides, const std::string& base_folder,
                         bool here);

}  // namespace pbf::inline campaign_module
