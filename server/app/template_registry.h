#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/ids.h"
#include "protocol/messages.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::app {

// The templates that are installed with the server. A template is a file `<slug>.json` that
// contains a Template of the protocol. The files are read once when the server starts.
class TemplateRegistry {
 public:
  // Refuses (500) an invalid Template, invalid lists of terms, and columns and layers of missing
  // tables. The error contains the name of the file. Returns no templates for an empty path.
  static Result<TemplateRegistry> load(const std::filesystem::path& folder);

  const std::vector<protocol::Template>& all() const { return templates_; }  // sorted by name
  const protocol::Template* find(const std::string& slug) const;             // null if missing

 private:
  std::vector<protocol::Template> templates_;
};

// Returns the label of an element in a language ("es", "es-MX"). If there is no such label, returns
// the English name.
std::string name_in(const std::string& name, const std::optional<protocol::Labels>& labels,
                    const std::optional<std::string>& language);

// Returns all labels of an element, including its English name.
Labels labels_with(const std::string& name, const std::optional<protocol::Labels>& labels);

// Returns the tables of the template for the store, with labels in a language. Slugs are always
// English, so scripts work in every language. Returns the same errors as load().
Result<std::vector<store::NewTable>> new_tables(const protocol::Template& of, ProjectId project_id,
                                                const std::optional<std::string>& language);

}  // namespace strata::app
