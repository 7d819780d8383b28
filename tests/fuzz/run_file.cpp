// Run files as input: whatever is damaged in one that pbf wrote, it can be read, or gives an Error.
// The fuzzer's bytes are changes: a place of 3 bytes (among the bytes that are not padding), a
// count and so many new bytes, again and again.
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <vector>

#include "lib/base/error.h"
#include "lib/io/run_file.h"
#include "tests/fuzz/memory_file.h"

namespace {

using namespace pbf;

FieldArray field(const char* name, ScalarType type, int components, std::size_t n) {
  FieldArray f{name, "1", type, components, {}};
  f.bytes.resize(n * static_cast<std::size_t>(components) * size_of(type));
  if (type == ScalarType::i32)
    for (std::size_t i = 0; i < n; ++i) f.as<std::int32_t>()[i] = static_cast<std::int32_t>(i);
  return f;
}

std::string sample() {
  const std::string path = "/tmp/pbf_fuzz_" + std::to_string(getpid()) + ".h5";
  {
    RunInfo info;
    info.particles = 5;
    info.bodies = {"float", "raft"};
    RunWriter writer(path, info, true);
    for (int k = 0; k < 3; ++k) {
      LogRow row;
      row.stages = {{"lambda", 0.5, 1}};
      writer.log(row);
      Snapshot s{k, 0.1 * k, 5, {}};
      s.fields = {field("position", ScalarType::f32, 3, 5), field("density", ScalarType::f32, 1, 5),
                  field("id", ScalarType::i32, 1, 5)};
      s.bodies.resize(info.bodies.size());
      writer.write(std::move(s));
    }
    writer.finish({"finished"});
  }
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  unlink(path.c_str());
  return bytes;
}

struct Sample {
  std::string bytes = sample();
  std::vector<std::size_t> places;  // that matter: not in the midst of zeros
  Sample() {
    std::size_t last = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (bytes[i]) last = i;
      if (i - last < 8) places.push_back(i);
    }
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Sample base;
  std::string bytes = base.bytes;
  for (std::size_t at = 0; at + 4 <= size;) {
    const std::size_t place =
        data[at] | std::size_t(data[at + 1]) << 8 | std::size_t(data[at + 2]) << 16;
    const std::size_t count = 1 + data[at + 3] % 8;
    at += 4;
    for (std::size_t k = 0; k < count && at < size; ++k, ++at)
      bytes[base.places[(place + k) % base.places.size()]] = static_cast<char>(data[at]);
  }
  const test::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const auto attempt = [](auto&& action) {
    try {
      action();
    } catch (const Error&) {
    }
  };
  attempt([&] {
    const RunReader run(file.path());
    attempt([&] { run.info(); });
    attempt([&] { run.status(); });
    attempt([&] { run.sessions(); });
    attempt([&] {
      for (const auto& name : run.log_columns()) run.log_column(name);
    });
    for (std::int64_t k = 0; k < run.frames() && k < 4; ++k) attempt([&] { run.frame(k); });
  });
  return 0;
}
