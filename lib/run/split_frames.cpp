#include "lib/run/split_frames.h"

#include <filesystem>
#include <utility>

namespace pbf::run_module {

SplitFrames::SplitFrames(SplitRows& rows, RunWriter& writer, const std::string& path,
                         const std::function<void(const std::string&)>& note)
    : rows_(rows), writer_(writer) {
  shared_ = rows_.share_file(std::filesystem::absolute(path).string(), writer_.inode());
  if (!shared_)
    note("not all ranks see " + path +
         ", so rank 0 writes for all, which is slower; give a folder that all machines share");
}

void SplitFrames::begin(const Snapshot& head, const TakeRows& look) {
  constexpr std::int64_t kLooked = std::int64_t{1} << 20;
  if (look) rows_.held(0, kLooked, look);
  const FramePlaces places = writer_.begin_frame(head);
  if (shared_ && !places.chunks.empty()) {
    rows_.write_held(places);
    under_way_ = true;
    return;
  }
  std::size_t field = 0;
  for (std::size_t k = 0; k < head.fields.size(); ++k) {
    if (head.fields[k].name == "id") continue;
    rows_.held(k, places.chunk_rows, [&](std::int64_t first, FieldArray&& piece) {
      writer_.rows(field, first, std::move(piece));
    });
    ++field;
  }
  writer_.commit_frame();
}

void SplitFrames::end(bool wait) {
  if (!under_way_ || !rows_.written(wait)) return;
  under_way_ = false;
  writer_.commit_frame();
}

}  // namespace pbf::run_module
