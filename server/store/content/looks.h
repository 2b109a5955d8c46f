#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/scene/look.h"
#include "store/content/first_answer.h"

namespace strata::store {

class Pool;

// Pictures of a model's surface, kept as they came. Part of Store: its rules for threads and
// errors hold.
class Looks {
 public:
  explicit Looks(Pool& pool) : pool_(pool) {}

  static constexpr int kMostLooks = 32;  // of a model

  Result<std::vector<Look>> of_model(std::int64_t model_id);  // by order
  Result<Look> find(std::int64_t model_id, const std::string& ref);
  Result<Look> create(const Look& look, std::span<const std::uint8_t> picture,
                      const FirstAnswer<Look>& answer = {});
  // all but its picture
  Result<Look> update(const Look& look, const FirstAnswer<Look>& answer = {});
  Result<void> remove(std::int64_t id, const FirstAnswer<>& answer = {});
  Result<std::vector<std::uint8_t>> picture(std::int64_t id);

 private:
  Pool& pool_;
};

}  // namespace strata::store
