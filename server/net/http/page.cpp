#include "net/http/page.h"

#include <algorithm>

#include "core/digest.h"
#include "core/text/base64.h"
#include "core/text/bytes.h"
#include "core/text/percent.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::size_t kMaxCursorLength = 6000;  // the whole head of a request has at most 8 KiB

// Decodes a cursor. Each text has only one valid cursor, so other encodings are refused.
std::optional<std::string> text_of_cursor(const std::string& cursor) {
  const auto bytes = from_base64(cursor);
  if (!bytes || to_base64url(*bytes) != cursor) return std::nullopt;
  return std::string(bytes->begin(), bytes->end());
}

bool is_of_page(const std::string& parameter) {
  return parameter == "limit" || parameter == "offset" || parameter == "after";
}

// Returns a text that identifies the list, its order and its filters.
std::string list_mark(const Request& request) {
  std::string text;
  for (const std::string& segment : request.segments)
    text += std::to_string(segment.size()) + ":" + segment;
  for (const auto& [key, value] : request.query)
    if (!is_of_page(key)) text += "?" + std::to_string(value.size()) + key + "=" + value;
  return sha256_hex(text).substr(0, 8);
}

bool is_value(const nlohmann::json& value) {
  return value.is_string() || value.is_number_integer() || value.is_number_float() ||
         value.is_null();
}

std::string text_of(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// Accepts only the texts that `cursor_of` returns.
Result<ListPlace> place_in(const Request& request, const std::string& cursor) {
  if (cursor.empty() || cursor.size() > kMaxCursorLength) return wrong_place();
  const auto text = text_of_cursor(cursor);
  if (!text) return wrong_place();
  auto read = nlohmann::json::parse(*text, nullptr, false);
  if (!read.is_array() || read.size() < 2 || read.front() != list_mark(request) ||
      !std::ranges::all_of(read, is_value) || text_of(read) != *text)
    return wrong_place();
  read.erase(read.begin());
  return read;
}

std::string link_to(const Request& request, const Page& page, const std::string& where,
                    const char* relation) {
  std::string target;  // encoded again because the original may be invalid in a header
  for (const auto& segment : request.segments) target += "/" + percent_encode(segment);
  target += "?";
  for (const auto& [key, value] : request.query)
    if (!is_of_page(key)) target += percent_encode(key) + "=" + percent_encode(value) + "&";
  return "<" + target + "limit=" + std::to_string(page.limit) + "&" + where + ">; rel=\"" +
         relation + "\"";
}

std::string offset_link(const Request& request, const Page& page, int offset,
                        const char* relation) {
  return link_to(request, page, "offset=" + std::to_string(offset), relation);
}

void add_links(Response& response, const Request& request, const Page& page, std::string links) {
  if (page.offset > 0)
    links += (links.empty() ? "" : ", ") +
             offset_link(request, page, std::max(0, page.offset - page.limit), "prev");
  if (!links.empty()) response.with("Link", links);
}

Slice slice_from(std::size_t begin, std::size_t count, const Page& page,
                 const std::function<ListPlace(std::size_t)>& place) {
  Slice slice;
  slice.begin = std::min(begin, count);
  slice.end = std::min(count, slice.begin + static_cast<std::size_t>(page.limit));
  if (slice.end < count && slice.end > slice.begin) slice.last = place(slice.end - 1);
  return slice;
}

}  // namespace

Result<Page> page_of(const Request& request, int default_limit) {
  Page page;
  page.limit = default_limit;
  if (auto found = request.query.find("limit"); found != request.query.end()) {
    auto limit = parse_integer(found->second, 1, kMaxPage, "limit");
    if (!limit) return tl::unexpected(limit.error());
    page.limit = static_cast<int>(*limit);
  }
  if (auto found = request.query.find("offset"); found != request.query.end()) {
    auto offset = parse_integer(found->second, 0, 1'000'000'000, "offset");
    if (!offset) return tl::unexpected(offset.error());
    page.offset = static_cast<int>(*offset);
  }
  if (auto found = request.query.find("after"); found != request.query.end()) {
    if (request.query.contains("offset"))
      return fail(ErrorCode::invalid, "`after` and `offset` together",
                  "Send either `after` or `offset`, but not both.", "after");
    auto place = STRATA_TRY(place_in(request, found->second));
    page.after = std::move(place);
  }
  return page;
}

std::optional<std::string> cursor_of(const Request& request, const ListPlace& place) {
  nlohmann::json marked = nlohmann::json::array({list_mark(request)});
  for (const auto& value : place) marked.push_back(value);
  std::string cursor = to_base64url(bytes_of(text_of(marked)));
  return cursor.size() <= kMaxCursorLength ? std::optional(std::move(cursor)) : std::nullopt;
}

void add_page_links(Response& response, const Request& request, const Page& page,
                    const std::optional<ListPlace>& last) {
  std::string next;
  if (last) {
    const auto cursor = cursor_of(request, *last);
    next = cursor ? link_to(request, page, "after=" + *cursor, "next")
                  : offset_link(request, page, page.offset + page.limit, "next");
  }
  add_links(response, request, page, std::move(next));
}

void add_page_links(Response& response, const Request& request, const Page& page,
                    std::int64_t total) {
  const bool goes_on = std::int64_t{page.offset} + page.limit < total;
  add_links(response, request, page,
            goes_on ? offset_link(request, page, page.offset + page.limit, "next") : std::string());
}

Result<std::int64_t> number_after(const Page& page, std::int64_t first) {
  if (!page.after) return first;
  if (page.after->size() != 1 || !page.after->front().is_number_integer()) return wrong_place();
  return page.after->front().get<std::int64_t>();
}

Result<Slice> slice_of(const Page& page, std::span<const NumberKey> sorted) {
  std::size_t begin = static_cast<std::size_t>(page.offset);
  if (page.after) {
    NumberKey after;
    for (const auto& value : *page.after) {
      if (!value.is_number_integer()) return wrong_place();
      after.push_back(value.get<std::int64_t>());
    }
    if (!sorted.empty() && sorted.front().size() != after.size()) return wrong_place();
    begin = static_cast<std::size_t>(std::ranges::upper_bound(sorted, after) - sorted.begin());
  }
  return slice_from(begin, sorted.size(), page,
                    [&](std::size_t at) { return ListPlace(sorted[at]); });
}

Result<Slice> slice_of(const Page& page, std::span<const store::NamedId> sorted,
                       store::Store& store) {
  std::size_t begin = static_cast<std::size_t>(page.offset);
  if (page.after) {
    const ListPlace& after = *page.after;
    if (after.size() != 2 || !after[0].is_string() || !after[1].is_number_integer())
      return wrong_place();
    auto until = store.projects().names_until(
        {after[0].get<std::string>(), after[1].get<std::int64_t>()}, sorted);
    if (!until) return tl::unexpected(until.error());
    begin = *until;
  }
  return slice_from(begin, sorted.size(), page, [&](std::size_t at) {
    return ListPlace::array({sorted[at].name, sorted[at].id});
  });
}

}  // namespace strata::net
