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

// Shapes for the brush, of the whole site. Part of Store: its rules for threads and errors hold.
class Tools {
 public:
  explicit Tools(Pool& pool) : pool_(pool) {}

  static constexpr int kMaxTools = 200;  // that are not deleted

  Result<std::vector<Tool>> all();  // that are not deleted, by name
  // By slug, those that are not deleted; by id, deleted ones, too.
  Result<Tool> find(const std::string& ref);
  Result<Tool> create(const Tool& tool, const ShapeBits& shape,
                      const IdempotentResponse<Tool>& answer = {});
  Result<Tool> update(const Tool& tool, const IdempotentResponse<Tool>& answer = {});  // its name
  Result<void> remove(ToolId id, const IdempotentResponse<>& answer = {});
  Result<ShapeBits> shape(ToolId id);  // deleted or not

 private:
  Pool& pool_;
};

}  // namespace strata::store
