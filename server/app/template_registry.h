#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/ids.h"
#include "protocol/messages.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::app {

// The templates that are installed with the server: `<slug>.json` in a folder, as the protocol's
// Template. Read once at start.
class TemplateRegistry {
 public:
  // Refuses (500), with the file's name: an invalid Template, invalid lists of terms, and columns
  // and layers of missing tables. An empty path gives no templates.
  static Result<TemplateRegistry> load(const std::filesystem::path& folder);

  const std::vector<protocol::Template>& all() const { return templates_; }  // by name
  const protocol::Template* find(const std::string& slug) const;             // null: not found

 private:
  std::vector<protocol::Template> templates_;
};

// Returns an element's label in a language ("es", "es-MX"), otherwise its English name.
std::string name_in(const std::string& name, const std::optional<protocol::Labels>& labels,
                    const std::optional<std::string>& language);

// Returns all labels of an element, including the English name.
Labels labels_with(const std::string& name, const std::optional<protocol::Labels>& labels);

// Returns the template's tables for the store, in a language. Slugs are always English, so that
// scripts work in every language. Refuses as load() does.
Result<std::vector<store::NewTable>> new_tables(const protocol::Template& of, ProjectId project_id,
                                                const std::optional<std::string>& language);

}  // namespace strata::app
