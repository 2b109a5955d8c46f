#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "domain/scene/model.h"
#include "domain/scene/surveyed_object.h"
#include "domain/tables/attachment.h"
#include "domain/tables/table.h"
#include "net/api/linked/linked_addresses.h"

// The entities of a site in Linked Art, with the terms of `linked_art()`, without `@context`.
namespace strata::net {

// The digital object, its creation, and the physical object that it shows. `with_source`: the
// caller may get the files of the scan.
nlohmann::json linked_model(const LinkedAddresses& addresses, const Model& model,
                            const std::vector<Layer>& layers, bool with_source);

// A physical object with its surveys. `models` are the models of the surveys.
nlohmann::json linked_object(const LinkedAddresses& addresses, const SurveyedObject& object,
                             const std::vector<Model>& models);

nlohmann::json linked_layer(const LinkedAddresses& addresses, const Model& model,
                            const Layer& layer);

// A place of a record on a model: a painted area, or a line or point of a column.
struct RecordSite {
  Model model;
  std::string label;                // "Damage on Wall"
  std::string annotation;           // address of the annotation; empty without one
  std::optional<double> area_m2{};  // of a painted area
  std::string wkt{};                // world coordinates; empty for an area
};

// A value of a term column: the term and its label.
struct RecordTerm {
  const Column* column = nullptr;
  std::int64_t key = 0;
  std::string label, uri;  // the uri may be empty or no IRI
};

// A record with all that the caller sees of it.
struct LinkedRecord {
  const Table& table;
  const Record& record;
  std::string name;
  std::vector<RecordTerm> terms;
  std::vector<RecordSite> sites;
  std::vector<Attachment> files;
  // The last change, if the caller may see it.
  std::string author{}, time{};
};

// A record is a feature of the objects on which it lies. If it has terms or choices, they describe
// its condition, which an assessment identified. Numbers are dimensions, and other values are
// statements.
nlohmann::json linked_record(const LinkedAddresses& addresses, const LinkedRecord& record);

}  // namespace strata::net
