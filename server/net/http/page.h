#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "net/http/http_types.h"
#include "store/content/named_id.h"
#include "store/tables/list_place.h"

namespace strata::store {
class Store;
}

// Pages of lists. `limit` is the size of a page. A page begins after the last entry of another page
// (`after`) or after a number of entries (`offset`). Only `after` remains correct while other users
// change the list.
namespace strata::net {

// The sort key of one entry. It is an array of numbers, texts and nulls. No two entries have the
// same key.
using ListPlace = nlohmann::json;

struct Page {
  int limit = 100;
  int offset = 0;
  std::optional<ListPlace> after{};
};
constexpr int kMaxPage = 1000;

// `default_limit` applies if `limit` is absent.
Result<Page> page_of(const Request& request, int default_limit = 100);

// Returns a position as a text for `after`. The text is valid only for the same list, filters and
// order. Returns nothing if the text is too long for an address.
std::optional<std::string> cursor_of(const Request& request, const ListPlace& place);

// Adds Link headers (next, prev). `last` is the end of the page, if more entries follow.
void add_page_links(Response& response, const Request& request, const Page& page,
                    const std::optional<ListPlace>& last);
// For lists that support only offsets.
void add_page_links(Response& response, const Request& request, const Page& page,
                    std::int64_t total);

// Returns the number after which the page begins, for lists that are sorted by one number. Returns
// `first` if there is no `after`. Refuses (422, `after`) a position with a different structure.
Result<std::int64_t> number_after(const Page& page, std::int64_t first = 0);
using store::wrong_place;

// Removes the rows after the page. Callers read one extra row to detect whether more entries
// follow. If so, returns `place_of` the last row of the page.
template <class Rows, class PlaceOf>
std::optional<ListPlace> end_page(Rows& rows, const Page& page, const PlaceOf& place_of) {
  if (rows.size() <= static_cast<std::size_t>(page.limit)) return std::nullopt;
  rows.erase(rows.begin() + page.limit, rows.end());
  return ListPlace(place_of(rows.back()));
}

// The part of a list in memory that belongs to a page.
struct Slice {
  std::size_t begin = 0, end = 0;
  std::optional<ListPlace> last{};  // set if more entries follow
};
using NumberKey = std::vector<std::int64_t>;  // compared number by number
Result<Slice> slice_of(const Page& page, std::span<const NumberKey> sorted);
// Like the function above, for a list that the database sorts by names
// (store::Projects::names_until).
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
