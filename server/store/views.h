#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/problem.h"
#include "store/first_answer.h"

namespace strata::store {

class Pool;

// A view of a model that people come back to: where from, and what is shown how.
struct NamedView {
  std::int64_t id = 0;
  std::int64_t model_id = 0;
  std::string slug;  // unique in the model; made of the name when it is empty
  std::string name;
  std::string text;        // plain, UTF-8, at most 10 000 characters
  nlohmann::json content;  // camera, layers, looks, light, as the protocol's View has them; layers and looks by id
  std::string user;        // who made it
  std::chrono::system_clock::time_point time;
  std::int64_t version = 1;
};

// Named views; of a Store, and as thread-safe and blocking as that, with the same Problems for what is not there, stale or away.
class Views {
 public:
  static constexpr std::int64_t kMostViews = 1000;  // of a model

  explicit Views(Pool& pool) : pool_(pool) {}

  struct Page {
    std::vector<NamedView> views;  // in the order in which they were made
    std::int64_t total = 0;
  };
  Result<Page> of_model(std::int64_t model_id, int limit, int offset);
  Result<NamedView> view(std::int64_t model_id, const std::string& ref);

  // Id, slug, time and version are given here. Refused: a blank name (422), one view too many (409).
  Result<NamedView> create(const NamedView& view, const FirstAnswer<NamedView>& answer = {});
  // Name, text and content, where version equals; the slug stays, so that links go on.
  Result<NamedView> update(const NamedView& view, const FirstAnswer<NamedView>& answer = {});
  Result<void> remove(const NamedView& view, const FirstAnswer<>& answer = {});  // where version equals

 private:
  Pool& pool_;
};

}  // namespace strata::store
