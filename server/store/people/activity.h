#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"

namespace strata::store {

// A line in the activity of a project: the actions of one user on one object, each within ten
// minutes of the previous action.
struct Activity {
  std::int64_t id = 0;
  std::chrono::system_clock::time_point time, begun;  // times of the last and the first action
  // empty for actions from the command line of the server
  std::string user;
  // "edit", "layer", "look", "view", "tour", "model", "table", "columns", "records", "comment",
  // "member", "project"
  std::string kind;
  // for an edit or an entry of a table: as in the journal; otherwise "created", "changed",
  // "deleted", …
  std::string op;
  std::string name;  // current or last name of the object; empty for a comment
  // The objects, if they still exist.
  std::optional<ModelId> model;
  std::optional<LayerId> layer;
  std::optional<TableId> table;
  std::optional<CommentId> comment;
  std::string model_name;
  // set if the whole line is about this record, which may be deleted
  std::optional<std::int64_t> record;
  std::string text;  // beginning of the comment
  // for changes to members: the user, the group, or both for a user in a group; `role` is the role
  // in the project, or of the user in the group, and empty if the membership ended
  std::string person, group, role;
  std::int64_t count = 1;  // number of edits, of written records or columns, or of changes
  std::optional<std::int64_t> texels;  // sum over the edits
  std::optional<double> area_m2;
  std::vector<std::string> changed;  // changed columns of the object
};

// The position at which a page ends. A line with a new action moves to the top, and so may move to
// another page.
struct ActivityPlace {
  std::int64_t time_us = 0;  // microseconds since 1970
  std::int64_t id = 0;
};

struct ActivityQuery {
  // Only lines about this model of the project, and about the tables with records on it.
  std::optional<ModelId> model{};
  std::optional<ActivityPlace> before{};
  bool with_members = false;  // also changes to roles
  int limit = 100;
};

struct ActivityPage {
  std::vector<Activity> lines;        // newest first
  std::optional<ActivityPlace> next;  // `before` of the next page
};

}  // namespace strata::store
