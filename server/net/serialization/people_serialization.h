#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "room/participants.h"
#include "room/room.h"
#include "store/people/people.h"
#include "store/store.h"

namespace strata::net {

// Returns a person's display name and color.
room::Portrait portrait_of(const store::Person& person);

// Adds `color` to the object that names this person.
void add_color(nlohmann::json& json, const store::Person& person);

// The accounts of the people that an answer names. A person without an account is shown by the name
// only.
class People {
 public:
  static Result<People> load(store::Store& store, const std::vector<std::string>& names);
  // Loads the people that `answer` names as `user` anywhere, and adds `full_name` (if set) and
  // `color` next to each.
  static Result<void> add_to(store::Store& store, nlohmann::json& answer);

  void add(nlohmann::json& answer) const;

 private:
  std::map<std::string, room::Portrait> portraits_;
};

}  // namespace strata::net
