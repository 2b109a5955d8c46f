#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "domain/tables/term_list.h"
#include "net/api/linked/linked_addresses.h"

// The catalog of a site and its lists of terms, with the terms of `catalog_terms()`, without
// `@context`.
namespace strata::net {

// The models and tables that the caller sees, as datasets (DCAT 3).
nlohmann::json linked_catalog(const LinkedAddresses& addresses, const std::vector<Model>& models,
                              const std::vector<Table>& tables);

// A table of records as a dataset. `keys` are those of the records on a page.
nlohmann::json linked_table(const LinkedAddresses& addresses, const Table& table,
                            std::span<const std::int64_t> keys);

// A list of terms as a concept scheme (SKOS) with all its concepts, and a single concept.
nlohmann::json linked_terms(const LinkedAddresses& addresses, const Table& table,
                            std::span<const ListedTerm> terms);
nlohmann::json linked_term(const LinkedAddresses& addresses, const Table& table,
                           const ListedTerm& term);

}  // namespace strata::net
