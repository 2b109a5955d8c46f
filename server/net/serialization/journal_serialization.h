#pragma once

#include <nlohmann/json.hpp>

namespace strata::store {
struct JournalRow;
struct ReviewQueue;
}  // namespace strata::store

namespace strata::net {

nlohmann::json to_json(const store::JournalRow& row);
nlohmann::json to_json(const store::ReviewQueue& queue);

}  // namespace strata::net
