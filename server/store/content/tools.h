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

// Brush shapes of the whole site. Part of Store: its rules for threads and errors hold.
class Tools {
 public:
  explicit Tools(Pool& pool) : pool_(pool) {}

  static constexpr int kMaxTools = 200;  // without deleted ones

  Result<std::vector<Tool>> all();  // without deleted ones, by name
  // A slug finds only tools that are not deleted; an id finds deleted tools, too.
  Result<Tool> find(const std::string& ref);
  Result<Tool> create(const Tool& tool, const ShapeBits& shape,
                      const IdempotentResponse<Tool>& answer = {});
  Result<Tool> update(const Tool& tool, const IdempotentResponse<Tool>& answer = {});  // changes
                                                                                       // the name
  Result<void> remove(ToolId id, const IdempotentResponse<>& answer = {});
  Result<ShapeBits> shape(ToolId id);  // of a deleted tool, too

 private:
  Pool& pool_;
};

}  // namespace strata::store
