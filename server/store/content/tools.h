#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/scene/tool.h"
#include "media/shape_texture.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;

// Brush shapes of the whole site. Part of Store, whose rules for threads and errors apply.
class Tools {
 public:
  explicit Tools(Pool& pool) : pool_(pool) {}

  static constexpr int kMaxTools = 200;  // without deleted tools

  Result<std::vector<Tool>> all();  // without deleted tools, sorted by name
  // Finds a tool by slug, if it is not deleted, or by id, also if it is deleted.
  Result<Tool> find(const std::string& ref);
  Result<Tool> create(const Tool& tool, const ShapeBits& shape,
                      const IdempotentResponse<Tool>& answer = {});
  // Changes the name.
  Result<Tool> update(const Tool& tool, const IdempotentResponse<Tool>& answer = {});
  Result<void> remove(ToolId id, const IdempotentResponse<>& answer = {});
  Result<ShapeBits> shape(ToolId id);  // also of a deleted tool

 private:
  Pool& pool_;
};

}  // namespace strata::store
