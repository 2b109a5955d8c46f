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

// Returns the display name and the color of a user.
room::Portrait portrait_of(const store::Person& person);

// Returns the full name of a user or, without one, the user name.
std::string written_name(store::Store& store, const std::string& user);

// Adds `color` to the object that names the user.
void add_color(nlohmann::json& json, const store::Person& person);

// The accounts of the users that a response names. A user without an account is shown only by the
// user name.
class People {
 public:
  static Result<People> load(store::Store& store, const std::vector<std::string>& names);
  // Loads each user whose name is a member `user` in `answer`. Adds `full_name` (if set) and
  // `color` next to that member.
  static Result<void> add_to(store::Store& store, nlohmann::json& answer);

  void add(nlohmann::json& answer) const;

 private:
  std::map<std::string, room::Portrait> portraits_;
};

}  // namespace strata::net
