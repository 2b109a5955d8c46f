#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;

// What people make of a model and come back to: a view (where from, and what is shown how) or a
// tour of views.
struct NamedPart {
  NamedPartId id = 0;
  ModelId model_id = 0;
  std::string slug;  // unique in the model; made of the name when it is empty
  std::string name;
  std::string text;  // plain, UTF-8, at most 10 000 characters
  // the rest of what the protocol's View or Tour has, with ids in place of slugs
  nlohmann::json content;
  std::string user;  // who made it
  std::chrono::system_clock::time_point time;
  std::int64_t version = 1;
};

// Named views of models, or tours; of a Store, and as thread-safe and blocking as that, with the
// same Problems for what is not there, stale or away.
class NamedParts {
 public:
  struct Kind {
    const char* name;   // of one
    const char* table;  // they have the same columns
    std::int64_t most;  // of a model
  };
  static constexpr Kind kViews{"view", "views", 1000}, kTours{"tour", "tours", 100};

  NamedParts(Pool& pool, const Kind& kind) : pool_(pool), kind_(kind) {}

  struct Page {
    std::vector<NamedPart> parts;  // in the order in which they were made
    std::int64_t total = 0;
  };
  // `after`: only those with higher ids.
  Result<Page> of_model(ModelId model_id, int limit, int offset, std::int64_t after = 0);
  Result<std::map<NamedPartId, std::string>> slugs(ModelId model_id);  // of all, by id
  Result<NamedPart> find(ModelId model_id, const std::string& ref);

  // Id, slug, time and version are given here. Refused: an empty name (malformed), one too many
  // (conflict).
  Result<NamedPart> create(const NamedPart& part, const IdempotentResponse<NamedPart>& answer = {});
  // Name, text and content, where version equals; the slug stays, so that links go on.
  Result<NamedPart> update(const NamedPart& part, const IdempotentResponse<NamedPart>& answer = {});
  // where version equals
  Result<void> remove(const NamedPart& part, const IdempotentResponse<>& answer = {});

 private:
  std::string sql(std::string text) const;

  Pool& pool_;
  const Kind kind_;
};

}  // namespace strata::store
