#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"

namespace strata::store {

// A line of a project's activity: the actions of one user on one object, each within ten minutes of
// the previous one.
struct Activity {
  std::int64_t id = 0;
  std::chrono::system_clock::time_point time, begun;  // of the last action, and of the first
  // empty: the server, by its command line
  std::string user;
  // "edit", "layer", "look", "view", "tour", "model", "table", "columns", "records", "comment",
  // "member", "project"
  std::string kind;
  // of an edit or a table's entry, as in its journal; "created", "changed", "deleted", …
  std::string op;
  std::string name;  // present or last name of the object; empty: a comment
  // Objects that still exist.
  std::optional<ModelId> model;
  std::optional<LayerId> layer;
  std::optional<TableId> table;
  std::optional<CommentId> comment;
  std::string model_name;
  // if the whole line is about this one, which may be deleted
  std::optional<std::int64_t> record;
  std::string text;  // beginning of the comment
  std::string person, group,
      // of a membership in the project or, if both are set, of the person in the group; empty: it
      // ended
      role;
  std::int64_t count = 1;  // strokes and other edits; records or columns written; changes
  std::optional<std::int64_t> texels;  // sum over the edits
  std::optional<double> area_m2;
  std::vector<std::string> changed;  // columns of the changed object
};

// The place where a page ends. A line that grows moves to the top, and so from one page to another.
struct ActivityPlace {
  std::int64_t time_us = 0;  // since 1970
  std::int64_t id = 0;
};

struct ActivityQuery {
  // Only lines of this model of the project, and of the tables whose records lie on it.
  std::optional<ModelId> model{};
  std::optional<ActivityPlace> before{};
  bool with_members = false;  // also changes of roles
  int limit = 100;
};

struct ActivityPage {
  std::vector<Activity> lines;        // newest first
  std::optional<ActivityPlace> next;  // `before` of the page that follows
};

}  // namespace strata::store
