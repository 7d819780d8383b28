// Which layers of cells each rank has.
#pragma once

#include <cstdint>
#include <vector>

namespace pbf::exec_module {

/// Slabs of layers, in the order of ranks, each of a layer at least.
class Slabs {
 public:
  Slabs() = default;
  /// in_layer: particles in each layer. Cuts are at multiples of `unit` layers. Throws
  /// Error(bad_input) if there are fewer units than ranks.
  Slabs(const std::vector<std::int64_t>& in_layer, int ranks, int unit);
  /// Moves the cuts if a rank has more than 1.01 times its share of the particles, and would have
  /// fewer; whether it did. No more than 4 % of a share, or one unit of layers, changes ranks at a
  /// cut: a rank has little room for what comes before others go.
  bool balance(const std::vector<std::int64_t>& in_layer);
  bool unfinished() const { return unfinished_; }  ///< whether the cuts are to move on
  /// Whether a rank with so many particles has clearly more than any had at the last balance().
  bool crowded(std::int64_t particles) const { return particles > most_ + most_ / 32; }

  int low(int rank) const { return cut_[std::size_t(rank)]; }
  int high(int rank) const { return cut_[std::size_t(rank) + 1]; }  ///< excluded
  int first_unit(int rank) const { return (cut_[std::size_t(rank)] + unit_ - 1) / unit_; }
  int owner(int layer) const { return owner_[std::size_t(layer)]; }
  const std::vector<int>& owners() const { return owner_; }  ///< rank of each layer
  bool operator==(const Slabs& other) const { return cut_ == other.cut_; }

 private:
  void cut(const std::vector<std::int64_t>& in_layer);
  void approach(const std::vector<int>& cuts, const std::vector<std::int64_t>& in_layer,
                std::int64_t most_moved);
  void own();
  std::int64_t most(const std::vector<std::int64_t>& in_layer) const;

  int ranks_ = 1, unit_ = 1;
  bool unfinished_ = false;
  std::int64_t most_ = 0;  ///< of a rank, at the last balance()
  std::vector<int> cut_, owner_;
};

}  // namespace pbf::exec_module
