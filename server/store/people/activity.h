#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"

namespace strata::store {

// A line of what was done in a project: what one person did to one thing, each time within ten
// minutes of the last one.
struct Activity {
  std::int64_t id = 0;
  std::chrono::system_clock::time_point time, begun;  // the last time, and the first
  // empty: the server itself, by its command line
  std::string user;
  // "edit", "layer", "look", "view", "tour", "model", "table", "columns", "records", "comment",
  // "member", "project"
  std::string kind;
  // of an edit or a table's entry as its journal has it; "created", "changed", "deleted", …
  std::string op;
  std::string name;  // of what it was done to, as it is called now, or was last; empty: a comment
  // What is still there.
  std::optional<ModelId> model;
  std::optional<LayerId> layer;
  std::optional<TableId> table;
  std::optional<CommentId> comment;
  std::string model_name;
  // where all of the line is about this one, which may be deleted
  std::optional<std::int64_t> record;
  std::string text;  // how the comment begins
  std::string person, group,
      // of a membership: in the project, or, where both are told, in the group; no role: it ended
      role;
  std::int64_t count = 1;  // strokes and other edits; records or columns written; changes
  std::optional<std::int64_t> texels;  // of edits: changed one after the other
  std::optional<double> area_m2;
  std::vector<std::string> changed;  // columns of what was changed
};

// Where a page of lines ends. A line that goes on meanwhile moves to the top, and so between pages.
struct ActivityPlace {
  std::int64_t time_us = 0;  // since 1970
  std::int64_t id = 0;
};

struct ActivityQuery {
  // Only of this one of the project's, and of the tables whose records lie on it.
  std::optional<ModelId> model{};
  std::optional<ActivityPlace> before{};
  bool with_members = false;  // also who was given which role
  int limit = 100;
};

struct ActivityPage {
  std::vector<Activity> lines;        // newest first
  std::optional<ActivityPlace> next;  // `before` of the page that follows
};

}  // namespace strata::store
