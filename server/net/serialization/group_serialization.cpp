#include "net/serialization/group_serialization.h"

#include "store/people/groups.h"

namespace strata::net {

nlohmann::json to_json(const store::ProjectGroup& group) {
  return {{"id", group.group.id},
          {"name", group.group.name},
          {"people", group.group.people},
          {"role", std::string(name(group.role))}};
}

}  // namespace strata::net
