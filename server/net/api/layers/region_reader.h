#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "protocol/messages.h"
#include "room/selection.h"

namespace strata::room {
class Room;
}

namespace strata::store {
struct NamedPart;
class NamedParts;
}  // namespace strata::store

namespace strata::net {

// Limits of a part of the surface. They also bound the stack that it needs.
constexpr int kMaxRegionDepth = 4;    // nested combinations, and nested saved selections
constexpr int kMaxRegionLeaves = 64;  // parts that are no combinations

// Converts a part of the surface from a request. Refuses missing layers and images, conditions that
// cannot be parsed, and combinations that are too large (422). Use one object for one part.
class RegionReader {
 public:
  // `reader` is the user of the request, who can use the own personal selections.
  RegionReader(const room::Room& room, store::NamedParts& selections, std::string reader)
      : room_(room), selections_(selections), reader_(std::move(reader)) {}
  // Refuses (422) this selection, because the definition is its own.
  void forbid(std::int64_t selection) { open_.push_back(selection); }

  // Replaces the names of layers, images and selections in `within` by ids, except in conditions.
  Result<room::Selection::Region> read(protocol::Within& within,
                                       const std::string& field = "within");
  // Returns the field of a personal selection that the part uses, or an empty text.
  const std::string& personal_field() const { return personal_field_; }

 private:
  Result<room::Selection::Region> region(protocol::Within& within, const std::string& field,
                                         int depth);
  Result<room::Selection::Combined> combined(std::vector<nlohmann::json>& parts,
                                             const std::string& field, int depth);
  Result<room::Selection::Combined> saved(protocol::LayerRef& ref, const std::string& field,
                                          int depth);
  Result<room::Selection::Like> like(protocol::Like& body, const std::string& field) const;
  Result<room::Selection::Unrolled> unrolled(const protocol::Unrolled& body,
                                             const std::string& field) const;

  const room::Room& room_;
  store::NamedParts& selections_;
  const std::string reader_;
  std::vector<std::int64_t> open_;  // the saved selections that are being read
  std::string personal_field_;
  int leaves_ = 0;
};

}  // namespace strata::net
