#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace strata::net {

// Returns a document of linked data as a page for people, with the same content. `address` is the
// address of the document, and `page` that of the entity on the page of the site; may be empty.
std::string linked_page(const nlohmann::json& document, const std::string& address,
                        const std::string& page);

}  // namespace strata::net
