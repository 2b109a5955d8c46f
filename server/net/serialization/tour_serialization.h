#pragma once

#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/route_help.h"
#include "store/content/named_parts.h"
#include "store/store.h"

namespace strata::net {

// What is kept of a tour, beside its name: languages, the time until it plays by itself, and stops,
// whose views, layers, tables and columns are named by id, since slugs change and things go.

// The stops as they are kept. 422 at the member that names what is not there for the role, or in
// the project, or twice.
Result<nlohmann::json> kept_stops(const RouteContext& context, const Model& model, Role role,
                                  const std::vector<protocol::TourStopCreate>& stops);
// 422: a language is named twice, a stop has no title in the first one, or words in another than
// these. Where only the languages are new, they are what is wrong.
Result<void> check_languages(const nlohmann::json& content, bool stops_are_new);

// As the protocol's Tour has it: of what it names, what is there for the role. `user` is told as
// given.
Result<nlohmann::json> to_json(const RouteContext& context, const store::NamedPart& tour, Role role,
                               const std::string& user);
nlohmann::json tour_entry(const store::NamedPart& tour, const std::string& user);

}  // namespace strata::net
