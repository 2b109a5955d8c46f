#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "net/http/http_types.h"
#include "store/content/projects.h"
#include "store/store.h"
#include "store/tables/list_place.h"

// Pages of lists: `limit`, and where the page begins: behind the entry at which another page ended
// (`after`), which stays right while others write, or behind so many entries (`offset`).
namespace strata::net {

// What a list is sorted by, of one entry: an array of whole numbers, texts and nulls, by which no
// two entries are alike.
using ListPlace = nlohmann::json;

struct Page {
  int limit = 100;
  int offset = 0;
  std::optional<ListPlace> after{};
};
constexpr int kMaxPage = 1000;

// Of lists that had no pages: `limit` is what it was not, absent, and so the largest.
Result<Page> page_of(const Request& request, int default_limit = 100);

// A place as `after` names it, good for the same list with the same filters and order alone;
// nothing: it is too long for an address.
std::optional<std::string> cursor_of(const Request& request, const ListPlace& place);

// Link header values (next, prev). `last`: where the page ends, while entries follow.
void add_page_links(Response& response, const Request& request, const Page& page,
                    const std::optional<ListPlace>& last);
// Of lists that know offsets alone.
void add_page_links(Response& response, const Request& request, const Page& page,
                    std::int64_t total);

// The number after which the page begins, of lists that are sorted by one; `first` where it begins
// at the beginning. Refused (422, `after`): a place of another shape.
Result<std::int64_t> number_after(const Page& page, std::int64_t first = 0);
using store::wrong_place;

// What was read in excess of the page is dropped: one more entry tells that the list goes on.
// `place_of` the last one that stays is told.
template <class Rows, class PlaceOf>
std::optional<ListPlace> end_page(Rows& rows, const Page& page, const PlaceOf& place_of) {
  if (rows.size() <= static_cast<std::size_t>(page.limit)) return std::nullopt;
  rows.erase(rows.begin() + page.limit, rows.end());
  return ListPlace(place_of(rows.back()));
}

// The entries of a list in memory that a page holds.
struct Slice {
  std::size_t begin = 0, end = 0;
  std::optional<ListPlace> last{};  // where entries follow
};
using NumberKey = std::vector<std::int64_t>;  // compared number by number
Result<Slice> slice_of(const Page& page, std::span<const NumberKey> sorted);
// The same of a list that the database sorts by names (store::Projects::names_until).
Result<Slice> slice_of(const Page& page, std::span<const store::NamedId> sorted,
                       store::Store& store);

template <class Items, class KeyOf>
Result<Slice> slice_by(const Page& page, const Items& items, const KeyOf& key_of) {
  std::vector<NumberKey> keys;
  for (const auto& item : items) keys.push_back(key_of(item));
  return slice_of(page, keys);
}
template <class Items, class NameOf>
Result<Slice> slice_by_name(const Page& page, const Items& items, store::Store& store,
                            const NameOf& name_of) {
  std::vector<store::NamedId> names;
  for (const auto& item : items) names.push_back(name_of(item));
  return slice_of(page, names, store);
}

}  // namespace strata::net
