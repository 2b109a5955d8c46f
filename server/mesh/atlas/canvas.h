#pragma once

#include <cstdint>
#include <vector>

#include "mesh/atlas/chart_mask.h"

namespace strata::mesh {

// The occupied texels of an atlas as bits, with the data for a fast search of the lowest free place
// of a chart's exact shape: charts lie in each other's bays and holes.
class Canvas {
 public:
  Canvas(int side, int gap) : Canvas(side, side, gap) {}
  Canvas(int width, int height, int gap);

  struct Spot {
    int x = -1, y = 0;
  };
  // Returns the lowest place from row `lowest` on, and of those the leftmost, whose texels are all
  // free, with y below `highest`; x < 0 where no such place exists.
  Spot find(const ChartMask& mask, int lowest, int highest);

  // Occupies the texels of the mask, and all within `gap` texels of them.
  void put(const ChartMask& mask, Spot spot);

  // How many words of bits were read and written: the amount of work, the same on every machine.
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
  // Bit x of a row of level j: whether any of texels x … x + 2^j - 1 is occupied. Rows have extra
  // words, which are free texels for reads beyond the end.
  std::vector<std::vector<Word>> levels_;
  // For each row: the longest run of free texels between the margins, measured on demand; less than
  // 0: not measured yet.
  std::vector<std::int32_t> longest_free_;
  std::uint64_t words_touched_ = 0;
  // in the searched row: places where the chart does not fit
  std::vector<Word> blocked_;
  std::vector<std::uint16_t> open_;       // its words with a free place
  std::vector<std::uint16_t> row_order_;  // of the mask: those that block most first
};

}  // namespace strata::mesh
