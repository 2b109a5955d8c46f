#pragma once

#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/route_help.h"
#include "net/serialization/tour_files.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {

// The stored content of a tour contains the languages, the time until the tour plays automatically,
// and the stops. It refers to views, layers, tables and columns by id because slugs can change.
// Tours from older versions have no members for media, themes and names of classes.

// Converts the stops to their stored format. Returns 422 at a member that names an entity twice.
// Also returns 422 at a member whose entity is missing in the project or invisible to the role.
Result<nlohmann::json> stored_stops(const RouteContext& context, const Model& model, Role role,
                                    const std::vector<protocol::TourStopCreate>& stops,
                                    const TourFilesById& files);
// Converts the names of classes in the same way.
Result<nlohmann::json> stored_classes(const RouteContext& context, const Model& model, Role role,
                                      const std::vector<protocol::TourClasses>& all);
// Returns 422 for a repeated language, a stop without a title in the first language, and texts in a
// language that the tour lacks. If the stops are not new, the error is at `languages`.
Result<void> check_languages(const nlohmann::json& content, bool stops_are_new);

// Returns the tour as Tour of the protocol. Includes only the entities that the role can see.
// `user` is copied to the result.
Result<nlohmann::json> to_json(const RouteContext& context, const store::NamedPart& tour, Role role,
                               const std::string& user);
nlohmann::json tour_entry(const store::NamedPart& tour, const std::string& user);

}  // namespace strata::net
