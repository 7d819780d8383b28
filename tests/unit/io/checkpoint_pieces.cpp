// Checkpoints that are written and read in pieces, as on several ranks.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "lib/base/error.h"
#include "lib/io/checkpoint.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

using namespace pbf;
using namespace pbf::test;

namespace {

/// Of so many particles, with a field of particles, one of as many numbers of something else as
/// `others` says, and counts.
SavedRun many(std::int64_t n, int others, Precision precision) {
  SavedRun s;
  s.particles = n;
  s.state.precision = precision;
  s.state.updates = 12;
  for (std::int64_t k = 0; k < 3 * n; ++k) {
    s.state.position.push_back(0.25 * double(k % 1000));
    s.state.velocity.push_back(-0.5 * double(k % 777));
  }
  for (std::int64_t k = 0; k < n; ++k) s.state.id.push_back(k);
  const auto field = [&](const char* name, bool real, std::int64_t rows, int numbers) {
    StoredField& f = s.state.fields.emplace_back(StoredField{name, real, numbers, {}});
    for (std::int64_t k = 0; k < rows * numbers; ++k) f.values.push_back(double(k % 513) - 7);
  };
  field("angle", true, n, 2);
  field("loads", false, others, 9);
  s.compression_max = 0.3;
  return s;
}
bool is_of_particles(const StoredField& f) { return f.name == "angle"; }
StoredField part_of_field(const StoredField& f, std::int64_t first, std::int64_t rows) {
  StoredField part{f.name, f.real, f.numbers, {}};
  const auto at = f.values.begin() + first * f.numbers;
  part.values.assign(at, at + rows * f.numbers);
  return part;
}
SolverState rows_of_state(const SolverState& s, std::int64_t first, std::int64_t rows) {
  SolverState part;
  part.position.assign(s.position.begin() + 3 * first, s.position.begin() + 3 * (first + rows));
  part.velocity.assign(s.velocity.begin() + 3 * first, s.velocity.begin() + 3 * (first + rows));
  part.id.assign(s.id.begin() + first, s.id.begin() + first + rows);
  for (const StoredField& f : s.fields)
    if (is_of_particles(f)) part.fields.push_back(part_of_field(f, first, rows));
  return part;
}
void write_in_pieces(const std::string& folder, const SavedRun& s) {
  SavedRun without = s;
  without.state = {};
  write_checkpoint(folder, without, [&](const StateSink& to) {
    SolverState head = s.state;
    head.position.clear(), head.velocity.clear(), head.id.clear();
    for (StoredField& f : head.fields)
      if (is_of_particles(f)) f.values.clear();
    to.head(std::move(head));
    for (std::int64_t at = 0; at < s.particles; at += kCheckpointRows)
      to.rows(at, rows_of_state(s.state, at, std::min(kCheckpointRows, s.particles - at)));
  });
}
bool same_values(const StoredField* a, const StoredField* b) {
  return a && b && a->numbers == b->numbers && a->values == b->values;
}
bool same_state(const SolverState& a, const SolverState& b) {
  return a.precision == b.precision && a.updates == b.updates && a.position == b.position &&
         a.velocity == b.velocity && a.id == b.id &&
         same_values(a.find("angle"), b.find("angle")) &&
         same_values(a.find("loads"), b.find("loads"));
}

}  // namespace

TEST_CASE("a checkpoint in pieces holds what one written at once holds, and is read in pieces",
          "[slow]") {
  struct Case {
    std::int64_t particles;
    int others;
  };
  for (const Case c : {Case{54, 6}, {9, 9}, {kCheckpointRows + 5, 6}})
    for (const Precision precision : {Precision::single, Precision::dbl}) {
      CAPTURE(c.particles, c.others);
      const TemporaryFolder folder;
      const SavedRun s = many(c.particles, c.others, precision);
      write_in_pieces(folder.path, s);
      std::vector<std::string> notes;
      const auto whole = read_checkpoint(folder.path, notes);
      REQUIRE(whole);
      CHECK(same_state(whole->state, s.state));
      CHECK(whole->compression_max == 0.3);
      CHECK(whole->path.empty());

      write_checkpoint(folder.path, s);  // at once
      const auto head = read_checkpoint(folder.path, notes, false);
      REQUIRE(head);
      CHECK(notes.empty());
      CHECK(head->state.position.empty());
      CHECK(head->particles == c.particles);
      CHECK(same_values(head->state.find("loads"), s.state.find("loads")));
      const CheckpointRows rows(*head);
      for (std::int64_t at = 0; at < c.particles; at += kCheckpointRows) {
        const std::int64_t n = std::min(kCheckpointRows, c.particles - at);
        const SolverState piece = rows.read(at, n), expected = rows_of_state(s.state, at, n);
        CHECK(piece.position == expected.position);
        CHECK(piece.velocity == expected.velocity);
        CHECK(piece.id == expected.id);
        CHECK(same_values(piece.find("angle"), expected.find("angle")));
      }
    }
}

TEST_CASE("a checkpoint that is read in pieces is checked to its last row") {
  const TemporaryFolder folder;
  const SavedRun before = many(50, 6, Precision::dbl), s = many(70, 6, Precision::dbl);
  write_in_pieces(folder.path, before);
  write_in_pieces(folder.path, s);
  const std::string path = folder / "checkpoint.h5";
  const auto size = std::int64_t(std::filesystem::file_size(path));
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  std::string bytes(std::size_t(size), ' ');
  file.read(bytes.data(), size);
  const double last = s.state.position.back();  // its last place in the file
  const std::size_t at =
      bytes.rfind(std::string(reinterpret_cast<const char*>(&last), sizeof last));
  REQUIRE(at != std::string::npos);
  file.seekp(std::streamoff(at + 3));
  file.put(char(bytes[at + 3] ^ 16));
  file.close();
  std::vector<std::string> notes;
  const auto read = read_checkpoint(folder.path, notes, false);
  REQUIRE(read);
  CHECK(read->particles == 50);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("checkpoint.h5: the checkpoint cannot be read") != std::string::npos);
}

TEST_CASE("a rank that fails while a checkpoint is written in pieces leaves the one before") {
  const TemporaryFolder folder;
  const SavedRun before = many(50, 6, Precision::dbl);
  write_in_pieces(folder.path, before);
  SavedRun s = many(70, 6, Precision::dbl);
  const auto fails = [&](const StateSink&) { throw Error(ExitCode::io, "a rank has failed"); };
  CHECK_THROWS_WITH(write_checkpoint(folder.path, s, fails), "a rank has failed");
  std::vector<std::string> notes;
  CHECK(same_state(read_checkpoint(folder.path, notes)->state, before.state));
  CHECK(notes.empty());
}
