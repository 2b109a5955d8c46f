#include "mesh/atlas/canvas.h"

#include <algorithm>
#include <array>
#include <bit>

#include "mesh/atlas/bits.h"

namespace strata::mesh {
namespace {

constexpr int kEdgeMargin = 1;  // texels kept free along the rim of the atlas
constexpr std::uint64_t kAll = ~std::uint64_t{0};

std::uint64_t shifted(const std::uint64_t* words, int word, int shift) {
  const std::uint64_t* from = words + word + shift / 64;
  const int bits = shift % 64;
  return bits == 0 ? from[0] : from[0] >> bits | from[1] << (64 - bits);
}

int longest_run(const ChartMask& mask, int row) {
  int length = 0;
  for (const auto& run : mask.row(row)) length = std::max(length, run.end - run.begin);
  return length;
}

// Sorts the rows of a mask: first the row with the longest run, then rows far apart, then the
// others. With this order, an occupied position is rejected early.
void order_rows(const ChartMask& mask, std::vector<std::uint16_t>& order) {
  order.clear();
  int longest = 0, length = 0;
  for (int y = 0; y < mask.height; ++y)
    if (const int run = longest_run(mask, y); run > length) longest = y, length = run;
  order.push_back(static_cast<std::uint16_t>(longest));
  const int last = mask.height - 1;
  if (last != longest) order.push_back(static_cast<std::uint16_t>(last));
  int step = static_cast<int>(std::bit_ceil(static_cast<unsigned>(mask.height)));
  for (int y = 0; y < last; y += step)
    if (y != longest) order.push_back(static_cast<std::uint16_t>(y));
  for (; step > 1; step /= 2)
    for (int y = step / 2; y < last; y += step)
      if (y != longest) order.push_back(static_cast<std::uint16_t>(y));
}

}  // namespace

Canvas::Canvas(int width, int height, int gap)
    : width_(width),
      height_(height),
      gap_(gap),
      word_count_((width + 63) / 64),
      stride_(2 * word_count_ + 2),
      longest_free_(height, width - 2 * kEdgeMargin) {
  levels_.resize(std::bit_width(static_cast<unsigned>(width)));
  for (auto& level : levels_) level.assign(static_cast<std::size_t>(stride_) * height, 0);
  blocked_.resize(word_count_);
}

void Canvas::block(const ChartMask& mask, int row, int y) {
  for (const auto& run : mask.row(row)) {
    const int length = run.end - run.begin;
    const int level = std::bit_width(static_cast<unsigned>(length)) - 1;
    const Word* line = words(level, y + row);
    const int second = run.end - (1 << level);
    std::size_t kept_words = 0;
    words_touched_ += open_.size();
    for (const auto word : open_) {
      const Word now =
          blocked_[word] | shifted(line, word, run.begin) | shifted(line, word, second);
      blocked_[word] = now;
      open_[kept_words] = word;
      kept_words += now != kAll;
    }
    open_.resize(kept_words);
    if (kept_words == 0) return;
  }
}

int Canvas::longest_free(int y) {
  if (longest_free_[y] >= 0) return longest_free_[y];
  const Word* line = words(0, y);
  words_touched_ += static_cast<std::uint64_t>(word_count_);
  int longest = 0, free_since = kEdgeMargin;
  for (int word = 0; word < word_count_; ++word) {
    // A free run extends from the end of an occupied run to the beginning of the next occupied run.
    Word taken = line[word];
    while (taken != 0) {
      const int begin = std::countr_zero(taken), length = std::countr_one(taken >> begin);
      longest = std::max(longest, 64 * word + begin - free_since);
      free_since = 64 * word + begin + length;
      taken = begin + length == 64 ? 0 : taken & kAll << (begin + length);
    }
  }
  return longest_free_[y] = std::max(longest, width_ - kEdgeMargin - free_since);
}

Canvas::Spot Canvas::find(const ChartMask& mask, int lowest, int highest) {
  const int first = kEdgeMargin, last = width_ - kEdgeMargin - mask.width;  // possible values of x
  highest = std::min(highest, height_ - kEdgeMargin - mask.height + 1);
  if (last < first) return {};
  order_rows(mask, row_order_);
  // These rows are checked first for a long enough run of free texels. Most rows of a filled atlas
  // have no such run.
  struct RowRun {
    int row, run;
  };
  std::array<RowRun, 5> samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const int row = i == 0 ? row_order_.front()
                           : static_cast<int>(i) * mask.height / static_cast<int>(samples.size());
    samples[i] = {row, longest_run(mask, row)};
  }
  std::sort(samples.begin(), samples.end(),
            [](const RowRun& a, const RowRun& b) { return a.run > b.run; });
  for (int y = std::max(lowest, kEdgeMargin); y < highest; ++y) {
    ++words_touched_;
    if (std::any_of(samples.begin(), samples.end(),
                    [&](const RowRun& a) { return longest_free(y + a.row) < a.run; }))
      continue;
    open_.clear();
    for (int word = first / 64; word <= last / 64; ++word) {
      blocked_[word] = ~bits_between(word, first, last + 1);
      open_.push_back(static_cast<std::uint16_t>(word));
    }
    for (const auto row : row_order_) {
      block(mask, row, y);
      if (open_.empty()) break;
    }
    if (!open_.empty()) return {64 * open_.front() + std::countr_one(blocked_[open_.front()]), y};
  }
  return {};
}

void Canvas::put(const ChartMask& mask, Spot spot) {
  const int low = std::max(0, spot.y - gap_), high = std::min(height_, spot.y + mask.height + gap_);
  for (int row = 0; row < mask.height; ++row)
    for (const auto& run : mask.row(row)) {
      const int begin = std::max(0, spot.x + run.begin - gap_),
                end = std::min(width_, spot.x + run.end + gap_);
      for (int y = std::max(low, spot.y + row - gap_); y < std::min(high, spot.y + row + gap_ + 1);
           ++y)
        for (int word = begin / 64; word <= (end - 1) / 64; ++word)
          words(0, y)[word] |= bits_between(word, begin, end);
    }
  const int first_word = std::max(0, spot.x - gap_) / 64;
  const int last_word = std::min(width_ - 1, spot.x + mask.width + gap_) / 64;
  for (int y = low; y < high; ++y) rebuild(y, first_word, last_word);
}

void Canvas::rebuild(int y, int first_word, int last_word) {
  longest_free_[y] = -1;
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    const int half = 1 << (level - 1);
    const Word* from = words(static_cast<int>(level) - 1, y);
    Word* to = words(static_cast<int>(level), y);
    const int begin = std::max(0, first_word - (2 * half) / 64 - 1);
    words_touched_ += static_cast<std::uint64_t>(last_word - begin + 1);
    for (int word = begin; word <= last_word; ++word)
      to[word] = from[word] | shifted(from, word, half);
  }
}

}  // namespace strata::mesh
