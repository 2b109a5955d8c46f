#include "core/ids.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>
#include <unordered_set>

namespace strata {
namespace {

// The purpose of the types is that none of these conversions compiles. A plain number that is known
// only at run time does not compile either, because the constructor for plain numbers is consteval.
// No type trait can check the behavior of a consteval constructor.
static_assert(!std::is_convertible_v<LayerId, TableId>);
static_assert(!std::is_constructible_v<LayerId, TableId>);
static_assert(!std::is_convertible_v<LayerId, std::int64_t>);
static_assert(sizeof(LayerId) == sizeof(std::int64_t));

TEST(Ids, are_written_and_read_as_numbers) {
  const LayerId id(std::int64_t{9007199254740991});
  const nlohmann::json json = id;
  EXPECT_EQ(json.dump(), "9007199254740991");
  EXPECT_EQ(json.get<LayerId>(), id);
  EXPECT_EQ(to_string(id), "9007199254740991");
  std::ostringstream out;
  out << id;
  EXPECT_EQ(out.str(), to_string(id));
  EXPECT_THROW(nlohmann::json("7").get<LayerId>(), nlohmann::json::type_error);
}

TEST(Ids, are_ordered_and_hashed_as_numbers) {
  EXPECT_LT(LayerId(2), LayerId(10));
  EXPECT_EQ(LayerId(), LayerId(0));
  const std::unordered_set<LayerId> ids{LayerId(3), LayerId(3), LayerId(4)};
  EXPECT_EQ(ids.size(), 2u);
  const std::vector<std::int64_t> numbers{5, 1};
  EXPECT_EQ(ids_of<GroupId>(numbers), (std::vector<GroupId>{GroupId(5), GroupId(1)}));
}

}  // namespace
}  // namespace strata
