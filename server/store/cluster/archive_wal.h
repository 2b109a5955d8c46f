#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

// The names of the files of the write-ahead log (WAL), and which of them an archive needs. A WAL
// segment has 16 MB, the size that `initdb` chooses.
namespace strata::store {

constexpr std::uint64_t kWalSegmentBytes = 16u << 20;

struct WalSegment {
  std::uint32_t timeline = 0;
  std::uint64_t number = 0;  // consecutive within the timeline
  auto operator<=>(const WalSegment&) const = default;
};

// Parses 24 hexadecimal digits, for example 000000010000000A000000FF.
std::optional<WalSegment> parse_wal_name(std::string_view name);
std::string wal_name(const WalSegment& segment);

// Returns the segment with which the recovery of a base copy begins. `backup_label` is the content
// of the file of that name in the copy.
std::optional<WalSegment> first_segment_of(std::string_view backup_label);

// Returns whether a file of the archived WAL can be deleted if the oldest kept copy begins with
// `first_needed`. Files of other timelines, timeline histories and unknown files are kept.
bool wal_can_go(std::string_view file, const WalSegment& first_needed);

// Returns the first segment that is not in `segments`, from `first` to the segment before `end`.
// `first` and `end` must be on the same timeline.
std::optional<WalSegment> first_missing(const std::set<WalSegment>& segments,
                                        const WalSegment& first, const WalSegment& end);

}  // namespace strata::store
