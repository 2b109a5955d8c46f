#include "render/memory/page_tables.h"

#include <algorithm>
#include <bit>
#include <span>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kMinTable = 4096;  // in entries
// Changed entries are uploaded together if the distance between them is at most kJoinGap.
constexpr std::uint32_t kJoinGap = 64;

}  // namespace

Result<std::uint32_t> PageTables::allocate(std::uint32_t count) {
  std::uint32_t offset = 0;
  if (const auto fitting = free_.find(count); fitting != free_.end()) {
    offset = fitting->second;
    free_.erase(fitting);
  } else {
    offset = static_cast<std::uint32_t>(entries_.size());
    entries_.resize(entries_.size() + count);
  }
  std::fill_n(entries_.begin() + offset, count, shader::kNoPage);
  for (std::uint32_t i = 0; i < count; ++i) changed_.push_back(offset + i);
  if (auto flushed = flush(); !flushed) {
    free(offset, count);
    return tl::unexpected(flushed.error());
  }
  return offset;
}

void PageTables::free(std::uint32_t offset, std::uint32_t count) { free_.emplace(count, offset); }

void PageTables::set(std::uint32_t index, PageId page) {
  entries_[index] = page;
  changed_.push_back(index);
}

Result<void> PageTables::flush() {
  const std::size_t needed = std::bit_ceil(std::max(entries_.size(), kMinTable)) * sizeof(PageId);
  if (buffer_.size() < needed) {
    auto share = STRATA_TRY(memory_.reserve(needed, "page tables"));
    auto buffer = STRATA_TRY(gl::Buffer::create(needed, gl::Buffer::Use::fixed, "page tables"));
    buffer_ = std::move(buffer);
    share_ = std::move(share);
    buffer_.upload_values(0, std::span<const PageId>(entries_));
    changed_.clear();
    return {};
  }
  std::sort(changed_.begin(), changed_.end());
  for (std::size_t first = 0; first < changed_.size();) {
    std::size_t last = first;
    while (last + 1 < changed_.size() && changed_[last + 1] - changed_[last] <= kJoinGap) ++last;
    const auto begin = changed_[first];
    buffer_.upload_values(begin * sizeof(PageId), std::span<const PageId>(entries_).subspan(
                                                      begin, changed_[last] + 1 - begin));
    first = last + 1;
  }
  changed_.clear();
  return {};
}

}  // namespace strata::render
