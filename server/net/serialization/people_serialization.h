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

// How somebody is shown: what they are called, and the colour of their account.
room::Portrait portrait_of(const store::Person& person);

// Puts `color` beside what names this person.
void add_color(nlohmann::json& json, const store::Person& person);

// Who names in an answer are of. Whoever has no account any more, or never had one here, is called
// by the name alone.
class People {
 public:
  static Result<People> load(store::Store& store, const std::vector<std::string>& names);
  // Those that `answer` names anywhere as `user`, and puts `full_name` (where there is one) and
  // `color` beside them.
  static Result<void> add_to(store::Store& store, nlohmann::json& answer);

  void add(nlohmann::json& answer) const;

 private:
  std::map<std::string, room::Portrait> portraits_;
};

}  // namespace strata::net
