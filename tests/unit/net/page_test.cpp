#include <gtest/gtest.h>

#include "net/http/page.h"

namespace strata::net {
namespace {

Request parsed(const std::string& target) {
  Request request;
  EXPECT_TRUE(parse_target(target, request)) << target;
  return request;
}

std::string after(const std::string& list, const ListPlace& place) {
  const char* join = list.find('?') == std::string::npos ? "?" : "&";
  return list + join + "after=" + cursor_of(parsed(list), place).value();
}

TEST(Page, limits_out_of_range_are_refused_and_links_lead_on) {
  EXPECT_FALSE(page_of(parsed("/a?limit=0")));
  EXPECT_FALSE(page_of(parsed("/a?limit=1001")));
  EXPECT_FALSE(page_of(parsed("/a?offset=-1")));
  EXPECT_FALSE(page_of(parsed("/a?limit=ten")));
  const Request request = parsed("/a?limit=10&offset=20&project=x");
  const auto page = page_of(request);
  ASSERT_TRUE(page);
  Response response;
  add_page_links(response, request, *page, 35);
  EXPECT_EQ(
      response.header("Link"),
      "</a?project=x&limit=10&offset=30>; rel=\"next\", </a?project=x&limit=10&offset=10>; rel=\"prev\"");
  Response last;
  add_page_links(last, request, *page, 30);
  EXPECT_EQ(last.header("Link"), "</a?project=x&limit=10&offset=10>; rel=\"prev\"");
  Response named;
  add_page_links(named, parsed("/b%20c/%E2%98\x83/?offset=10"), {10, 10}, 20);
  EXPECT_EQ(named.header("Link"), "</b%20c/%E2%98%83/?limit=10&offset=0>; rel=\"prev\"")
      << "whatever was sent, ASCII";
}

TEST(Page, a_place_comes_back_as_it_was) {
  for (const ListPlace& place :
       {ListPlace::array({7}), ListPlace::array({INT64_MIN, INT64_MAX}),
        ListPlace::array({"Ä ?&=\"\\", nullptr, 0.1}), ListPlace::array({"", 3})}) {
    const auto page = page_of(parsed(after("/a/b?sortby=x&limit=3", place)));
    ASSERT_TRUE(page) << page.error().detail;
    EXPECT_EQ(page->after, place);
    EXPECT_EQ(page->limit, 3);
  }
}

TEST(Page, a_place_is_good_for_its_own_list_filters_and_order_alone) {
  const std::string cursor = cursor_of(parsed("/a/b?filter=x"), ListPlace::array({7})).value();
  EXPECT_TRUE(page_of(parsed("/a/b?filter=x&limit=9&after=" + cursor)));
  for (const char* other :
       {"/a/b?", "/a/b?filter=y&", "/a/b?filter=x&sortby=z&", "/a/c?filter=x&", "/a?filter=x&"}) {
    const auto page = page_of(parsed(other + std::string("after=") + cursor));
    ASSERT_FALSE(page) << other;
    EXPECT_EQ(page.error().code, ErrorCode::invalid);
    EXPECT_EQ(page.error().field, "after");
  }
}

TEST(Page, what_is_no_place_is_refused) {
  const std::string cursor = cursor_of(parsed("/a"), ListPlace::array({7})).value();
  for (const std::string& sent : {std::string(), std::string("x"), cursor + "A", cursor + "=",
                                  cursor + "%0A", cursor.substr(1), std::string(7000, 'A'),
                                  std::string("e30"), std::string("W10"), std::string("bnVsbA")})
    EXPECT_FALSE(page_of(parsed("/a?after=" + sent))) << sent;
  EXPECT_EQ(page_of(parsed("/a?offset=1&after=" + cursor)).error().field, "after");
}

TEST(Page, a_place_too_long_for_an_address_has_no_text) {
  EXPECT_FALSE(cursor_of(parsed("/a"), ListPlace::array({std::string(6000, 'x')})));
  Response response;
  add_page_links(response, parsed("/a?offset=4"), {2, 4},
                 std::optional(ListPlace::array({std::string(6000, 'x')})));
  EXPECT_EQ(response.header("Link"),
            "</a?limit=2&offset=6>; rel=\"next\", </a?limit=2&offset=2>; rel=\"prev\"");
}

TEST(Page, entries_follow_a_place_whether_or_not_it_is_still_there) {
  const auto keys_after = [](std::vector<NumberKey> keys, const ListPlace& place, int limit) {
    const auto part = slice_of(Page{limit, 0, place}, keys);
    EXPECT_TRUE(part);
    return std::vector(keys.begin() + static_cast<std::ptrdiff_t>(part->begin),
                       keys.begin() + static_cast<std::ptrdiff_t>(part->end));
  };
  using Keys = std::vector<NumberKey>;
  EXPECT_EQ(keys_after({{1, 5}, {2, 3}, {2, 4}}, ListPlace::array({2, 3}), 9), Keys({{2, 4}}));
  EXPECT_EQ(keys_after({{1, 5}, {2, 2}, {2, 4}}, ListPlace::array({2, 3}), 9), Keys({{2, 4}}));
  EXPECT_EQ(keys_after({{1, 5}, {2, 3}}, ListPlace::array({0, 0}), 1), Keys({{1, 5}}));
  EXPECT_EQ(keys_after({{1, 5}}, ListPlace::array({9, 9}), 9), Keys());
  EXPECT_EQ(keys_after({}, ListPlace::array({9, 9}), 9), Keys());
  for (const ListPlace& wrong : {ListPlace::array({1}), ListPlace::array({1, 2, 3}),
                                 ListPlace::array({"1", 2}), ListPlace::array({nullptr, 2})})
    EXPECT_FALSE(slice_of(Page{9, 0, wrong}, Keys({{1, 5}})));
}

TEST(Page, the_last_page_tells_no_next_one) {
  const std::vector<NumberKey> keys{{1}, {2}, {3}};
  EXPECT_EQ(slice_of(Page{2, 0, {}}, keys)->last, ListPlace::array({2}));
  EXPECT_FALSE(slice_of(Page{3, 0, {}}, keys)->last);
  EXPECT_FALSE(slice_of(Page{2, 2, {}}, keys)->last);
  EXPECT_FALSE(slice_of(Page{2, 9, {}}, keys)->last);
  std::vector<int> rows{1, 2, 3};
  EXPECT_EQ(end_page(rows, Page{2, 0, {}}, [](int row) { return ListPlace::array({row}); }),
            ListPlace::array({2}));
  EXPECT_EQ(rows, std::vector({1, 2}));
  EXPECT_FALSE(end_page(rows, Page{2, 0, {}}, [](int row) { return ListPlace::array({row}); }));
}

}  // namespace
}  // namespace strata::net
