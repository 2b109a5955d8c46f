#include "store/cluster/archive_wal.h"

#include <charconv>
#include <cstdio>

namespace strata::store {
namespace {

constexpr std::size_t kWalNameLength = 24;
constexpr std::uint64_t kSegmentsPerLog = (std::uint64_t{4} << 30) / kWalSegmentBytes;

// PostgreSQL writes capital letters only.
std::optional<std::uint32_t> eight_digits(std::string_view text) {
  if (text.find_first_not_of("0123456789ABCDEF") != std::string_view::npos) return std::nullopt;
  std::uint32_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return value;
}

}  // namespace

std::optional<WalSegment> parse_wal_name(std::string_view name) {
  if (name.size() != kWalNameLength) return std::nullopt;
  const auto timeline = eight_digits(name.substr(0, 8)), log = eight_digits(name.substr(8, 8)),
             part = eight_digits(name.substr(16, 8));
  if (!timeline || !log || !part || *part >= kSegmentsPerLog) return std::nullopt;
  return WalSegment{*timeline, *log * kSegmentsPerLog + *part};
}

std::string wal_name(const WalSegment& segment) {
  char name[kWalNameLength + 1];
  std::snprintf(name, sizeof name, "%08X%08X%08X", segment.timeline,
                static_cast<unsigned>(segment.number / kSegmentsPerLog),
                static_cast<unsigned>(segment.number % kSegmentsPerLog));
  return name;
}

std::optional<WalSegment> first_segment_of(std::string_view backup_label) {
  constexpr std::string_view kBefore = "START WAL LOCATION: ", kFile = "(file ";
  if (!backup_label.starts_with(kBefore)) return std::nullopt;
  const auto file = backup_label.find(kFile);
  if (file == std::string_view::npos) return std::nullopt;
  return parse_wal_name(backup_label.substr(file + kFile.size(), kWalNameLength));
}

bool wal_can_go(std::string_view file, const WalSegment& first_needed) {
  const auto segment = parse_wal_name(file.substr(0, kWalNameLength));
  // The rest of the name is .gz, .gz.part or, for the label of a copy, .00000028.backup.gz.
  if (!segment || (file.size() > kWalNameLength && file[kWalNameLength] != '.')) return false;
  return segment->timeline == first_needed.timeline && segment->number < first_needed.number;
}

std::optional<WalSegment> first_missing(const std::set<WalSegment>& segments,
                                        const WalSegment& first, const WalSegment& end) {
  for (WalSegment at = first; at < end; ++at.number)
    if (!segments.contains(at)) return at;
  return std::nullopt;
}

}  // namespace strata::store
