#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

// Defines one type of id for each kind of row, so the id of a layer cannot be used for a table. The
// server converts numbers to ids when it reads an address, a message or a row of the database. It
// converts ids to numbers when it writes them.
namespace strata {

template <class Kind>
class Id {
 public:
  constexpr Id() = default;  // no row has this default id
  constexpr explicit Id(std::int64_t number) : number_(number) {}
  // Accepts a literal number in the code.
  // NOLINTNEXTLINE(google-explicit-constructor, hicpp-explicit-conversions)
  consteval Id(int number) : number_(number) {}

  constexpr std::int64_t number() const { return number_; }
  auto operator<=>(const Id&) const = default;

  friend std::string to_string(Id id) { return std::to_string(id.number_); }
  template <class Json>
  friend void to_json(Json& json, Id id) {
    json = id.number_;
  }
  template <class Json>
  friend void from_json(const Json& json, Id& id) {
    id.number_ = json.template get<std::int64_t>();
  }
  friend std::ostream& operator<<(std::ostream& out, Id id) { return out << id.number_; }

 private:
  std::int64_t number_ = 0;
};

// Converts numbers from a request to ids.
template <class Id>
std::vector<Id> ids_of(std::span<const std::int64_t> numbers) {
  std::vector<Id> ids;
  ids.reserve(numbers.size());
  for (const std::int64_t number : numbers) ids.emplace_back(number);
  return ids;
}

using ProjectId = Id<struct ProjectTag>;
using ModelId = Id<struct ModelTag>;
using ObjectId = Id<struct ObjectTag>;  // objects with surveys
using LayerId = Id<struct LayerTag>;
using SurfaceImageId = Id<struct SurfaceImageTag>;
using TableId = Id<struct TableTag>;
using ColumnId = Id<struct ColumnTag>;
using AttachmentId = Id<struct AttachmentTag>;
using CommentId = Id<struct CommentTag>;
using PersonId = Id<struct PersonTag>;
using GroupId = Id<struct GroupTag>;
using KioskId = Id<struct KioskTag>;
using NamedPartId = Id<struct NamedPartTag>;  // views and tours of a model
using TokenId = Id<struct TokenTag>;          // sessions and other secrets for signing in
using ToolId = Id<struct ToolTag>;
using JobId = Id<struct JobTag>;

}  // namespace strata

template <class Kind>
struct std::hash<strata::Id<Kind>> {
  std::size_t operator()(strata::Id<Kind> id) const noexcept {
    return std::hash<std::int64_t>()(id.number());
  }
};
