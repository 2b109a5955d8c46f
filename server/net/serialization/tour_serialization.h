#pragma once

#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/route_help.h"
#include "net/serialization/tour_files.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {

// The stored content of a tour: languages, the time until it plays by itself, and
// stops, which name views, layers, tables and columns by id, since slugs change. Tours that were
// stored before there were media, themes and names of classes have none of these members.

// Returns the stored form of the stops. 422 at the member that names an entity twice, or one that
// is missing in the project or invisible to the role.
Result<nlohmann::json> stored_stops(const RouteContext& context, const Model& model, Role role,
                                    const std::vector<protocol::TourStopCreate>& stops,
                                    const TourFilesById& files);
// The same for the names of classes.
Result<nlohmann::json> stored_classes(const RouteContext& context, const Model& model, Role role,
                                      const std::vector<protocol::TourClasses>& all);
// 422: a language occurs twice, a stop has no title in the first language, or it has texts in other
// languages. If only the languages are new, the error names them.
Result<void> check_languages(const nlohmann::json& content, bool stops_are_new);

// Returns the protocol's Tour with the named entities that the role can see. `user` is copied.
Result<nlohmann::json> to_json(const RouteContext& context, const store::NamedPart& tour, Role role,
                               const std::string& user);
nlohmann::json tour_entry(const store::NamedPart& tour, const std::string& user);

}  // namespace strata::net
