#pragma once

#include <cstdint>
#include <vector>

#include "mesh/atlas/chart_mask.h"

namespace strata::mesh {

// The occupied texels of an atlas as bits, with data for a fast search for the lowest free position
// of a chart's exact shape. Charts can be placed in the bays and holes of other charts.
class Canvas {
 public:
  Canvas(int side, int gap) : Canvas(side, side, gap) {}
  Canvas(int width, int height, int gap);

  struct Spot {
    int x = -1, y = 0;
  };
  // Returns a position where all texels of the mask are free, with `lowest` ≤ y < `highest`. It
  // is the lowest of these positions, or the leftmost if several are equally low. Returns x < 0 if
  // no such position exists.
  Spot find(const ChartMask& mask, int lowest, int highest);

  // Occupies the texels of the mask and all texels within a distance of `gap` texels.
  void put(const ChartMask& mask, Spot spot);

  // Returns the number of words of bits read and written. This measure of the work is the same on
  // every machine.
  std::uint64_t words_touched() const { return words_touched_; }

 private:
  using Word = std::uint64_t;
  const Word* words(int level, int y) const {
    return &levels_[level][static_cast<std::size_t>(y) * stride_];
  }
  Word* words(int level, int y) { return &levels_[level][static_cast<std::size_t>(y) * stride_]; }
  void block(const ChartMask& mask, int row, int y);
  void rebuild(int y, int first_word, int last_word);
  int longest_free(int y);

  const int width_, height_, gap_, word_count_, stride_;
  // Bit x of a row at level j is set if any of the texels x … x + 2^j - 1 is occupied. Each
  // row ends with extra words, so reads beyond its end return free texels.
  std::vector<std::vector<Word>> levels_;
  // For each row, the longest run of free texels between the margins. It is measured on demand. A
  // value less than 0 means not measured yet.
  std::vector<std::int32_t> longest_free_;
  std::uint64_t words_touched_ = 0;
  // in the searched row: positions where the chart does not fit
  std::vector<Word> blocked_;
  std::vector<std::uint16_t> open_;       // words of blocked_ with a free position
  std::vector<std::uint16_t> row_order_;  // rows of the mask; the rows that block most come first
};

}  // namespace strata::mesh
