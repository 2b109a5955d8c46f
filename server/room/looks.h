#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/scene/look.h"
#include "store/content/first_answer.h"

namespace strata::room {

// Pictures of the surface. Thread-safe. Changes block (database) and are announced to the
// listeners.
class Looks {
 public:
  virtual ~Looks() = default;
  virtual std::vector<Look> all() const = 0;                    // by order
  virtual Result<Look> find(const std::string& ref) const = 0;  // id or slug
  virtual Result<Look> create(Look look, std::span<const std::uint8_t> picture,
                              const store::FirstAnswer<Look>& answer = {}) = 0;
  virtual Result<Look> update(const Look& look, const store::FirstAnswer<Look>& answer = {}) = 0;
  virtual Result<void> erase(std::int64_t id, const store::FirstAnswer<>& answer = {}) = 0;
};

}  // namespace strata::room
