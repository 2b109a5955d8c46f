#include "net/serialization/people_serialization.h"

#include <functional>
#include <set>

#include "domain/people/person_color.h"
#include "room/participants.h"
#include "store/people/accounts.h"

namespace strata::net {
namespace {

// Visits every object in `json` that names a user.
void each_with_user(nlohmann::json& json,
                    const std::function<void(nlohmann::json&, const std::string&)>& found) {
  if (json.is_array() || json.is_object())
    for (nlohmann::json& part : json) each_with_user(part, found);
  if (!json.is_object()) return;
  const auto user = json.find("user");
  if (user != json.end() && user->is_string()) found(json, user->get<std::string>());
}

}  // namespace

room::Portrait portrait_of(const store::Person& person) {
  return {person.full_name, std::string(person_color(person.id))};
}

std::string written_name(store::Store& store, const std::string& user) {
  const auto person = store.accounts().find(user);
  return person && !person->full_name.empty() ? person->full_name : user;
}

void add_color(nlohmann::json& json, const store::Person& person) {
  json["color"] = person_color(person.id);
}

Result<People> People::load(store::Store& store, const std::vector<std::string>& names) {
  People people;
  if (names.empty()) return people;
  const auto found = STRATA_TRY(store.accounts().called(names));
  for (const store::Person& person : found) people.portraits_[person.name] = portrait_of(person);
  return people;
}

Result<void> People::add_to(store::Store& store, nlohmann::json& answer) {
  std::set<std::string> names;
  each_with_user(answer, [&](nlohmann::json&, const std::string& user) { names.insert(user); });
  const auto people = STRATA_TRY(load(store, {names.begin(), names.end()}));
  people.add(answer);
  return {};
}

void People::add(nlohmann::json& answer) const {
  each_with_user(answer, [this](nlohmann::json& of, const std::string& user) {
    const auto known = portraits_.find(user);
    const room::Portrait portrait = known == portraits_.end() ? room::Portrait() : known->second;
    if (!portrait.full_name.empty()) of["full_name"] = portrait.full_name;
    of["color"] = portrait.color;
  });
}

}  // namespace strata::net
