#pragma once

#include "net/api/routes.h"

namespace strata::net {

// Told to who looks at a model of the table's project, with the columns that they see.
void tell_table(const RouteContext& context, protocol::TableEventEvent event, const Table& table,
                const std::string& user);
// Each record that changed; the table instead where its columns changed, too, or there are too many
// to tell.
void tell_change(const RouteContext& context, const store::TableChange& change,
                 const std::string& user);

}  // namespace strata::net
