#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "core/memory_ledger.h"

namespace strata {
namespace {

TEST(MemoryLedger, refuses_what_does_not_fit_and_names_the_option) {
  MemoryLedger ledger("main memory", "--memory", 100);
  auto share = ledger.reserve(60, "a map");
  ASSERT_TRUE(share);
  const auto refused = ledger.reserve(41, "a second map");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
  EXPECT_NE(refused.error().detail.find("a second map"), std::string::npos);
  EXPECT_NE(refused.error().detail.find("--memory"), std::string::npos);
  EXPECT_EQ(ledger.used(), 60u);
  share->reset();
  EXPECT_TRUE(ledger.reserve(100, "a map"));
  EXPECT_EQ(ledger.used(), 0u) << "a share that is gone counts no more";
}

TEST(MemoryLedger, evicts_until_it_fits) {
  MemoryLedger ledger("main memory", "--memory", 100);
  std::vector<MemoryLedger::Share> shares;
  for (int i = 0; i < 4; ++i) shares.push_back(std::move(*ledger.reserve(25, "a map")));
  ledger.set_evictor([&] {
    if (shares.size() <= 1) return false;
    shares.pop_back();
    return true;
  });
  EXPECT_TRUE(ledger.reserve(60, "a large map"));
  EXPECT_EQ(shares.size(), 1u);
  EXPECT_FALSE(ledger.reserve(80, "a larger map"));
}

TEST(MemoryLedger, counts_what_grew_already_beyond_the_budget) {
  MemoryLedger ledger("main memory", "--memory", 100);
  auto share = ledger.reserve(10, "a layer");
  share->recount(150);
  EXPECT_TRUE(ledger.exceeded());
  share->recount(20);
  EXPECT_FALSE(ledger.exceeded());
  EXPECT_EQ(ledger.used(), 20u);
}

TEST(MemoryLedger, never_gives_more_than_the_budget_to_many_at_once) {
  MemoryLedger ledger("main memory", "--memory", 1000);
  std::atomic<bool> exceeded{false};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 20'000; ++i) {
        auto share = ledger.reserve(static_cast<std::uint64_t>(i % 400), "a part");
        if (ledger.exceeded()) exceeded = true;
      }
    });
  threads.clear();
  EXPECT_FALSE(exceeded);
  EXPECT_EQ(ledger.used(), 0u);
}

}  // namespace
}  // namespace strata
