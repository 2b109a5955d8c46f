#include "store/cluster/archive_wal.h"

#include <gtest/gtest.h>

namespace strata::store {
namespace {

TEST(ArchiveWal, names_of_segments_are_consecutive_numbers) {
  const auto last = parse_wal_name("000000010000000A000000FF");
  ASSERT_TRUE(last);
  EXPECT_EQ(*last, (WalSegment{1, 0xAFF}));
  EXPECT_EQ(wal_name({last->timeline, last->number + 1}), "000000010000000B00000000");
  EXPECT_EQ(wal_name(*last), "000000010000000A000000FF");
}

TEST(ArchiveWal, other_names_are_not_segments) {
  for (const char* name :
       {"", "00000002.history", "000000010000000A000000FF.gz", "000000010000000a000000ff",
        "000000010000000A00000100", "000000010000000A000000F", "00000001000000 A000000FF"})
    EXPECT_FALSE(parse_wal_name(name)) << name;
}

TEST(ArchiveWal, a_backup_label_names_the_first_segment) {
  EXPECT_EQ(first_segment_of("START WAL LOCATION: 0/2000060 (file 000000010000000000000002)\n"
                             "CHECKPOINT LOCATION: 0/2000098\n"),
            (WalSegment{1, 2}));
  EXPECT_FALSE(first_segment_of(""));
  EXPECT_FALSE(first_segment_of("START WAL LOCATION: 0/2000060 (file 00000001"));
  EXPECT_FALSE(first_segment_of("CHECKPOINT LOCATION: 0/2000098\n"));
}

TEST(ArchiveWal, only_wal_before_the_oldest_copy_can_go) {
  const WalSegment first{1, 0x105};
  for (const char* name :
       {"000000010000000100000004.gz", "000000010000000000000002.gz",
        "000000010000000100000004.gz.part", "000000010000000100000004.00000028.backup.gz"})
    EXPECT_TRUE(wal_can_go(name, first)) << name;
  for (const char* name :
       {"000000010000000100000005.gz", "000000010000000200000000.gz",
        "000000010000000100000005.00000028.backup.gz", "000000020000000000000001.gz",
        "00000002.history.gz", "notes.txt", "", "0000000100000001000000040.gz"})
    EXPECT_FALSE(wal_can_go(name, first)) << name;
}

TEST(ArchiveWal, the_first_missing_segment_is_found) {
  const std::set<WalSegment> segments{{1, 2}, {1, 3}, {1, 5}, {1, 6}};
  EXPECT_EQ(first_missing(segments, {1, 2}, {1, 7}), (WalSegment{1, 4}));
  EXPECT_EQ(first_missing(segments, {1, 5}, {1, 8}), (WalSegment{1, 7}));
  EXPECT_EQ(first_missing(segments, {1, 2}, {1, 4}), std::nullopt);
  EXPECT_EQ(first_missing(segments, {1, 5}, {1, 5}), std::nullopt);
  EXPECT_EQ(first_missing({}, {1, 1}, {1, 2}), (WalSegment{1, 1}));
}

}  // namespace
}  // namespace strata::store
