#include "net/api/linked/linked_entities.h"

#include <set>

#include "core/text/percent.h"
#include "domain/layers/layer.h"
#include "domain/tables/column_value.h"
#include "net/api/linked/linked_terms.h"
#include "vocabulary/rdf.h"

namespace strata::net {
namespace {

const char* kDescription = "300435416";
const char* kCreditLine = "300435418";
const char* kLicence = "300435434";
const char* kAccessionNumber = "300312355";

nlohmann::json name_of(const std::string& name) { return {{"type", "Name"}, {"content", name}}; }

nlohmann::json digital(const std::string& id, const std::string& label, const char* format) {
  return {{"id", id}, {"type", "DigitalObject"}, {"_label", label}, {"format", format}};
}

nlohmann::json dimension(const std::string& label, const nlohmann::json& value,
                         const std::string& unit) {
  nlohmann::json json{{"type", "Dimension"}, {"_label", label}, {"value", value}};
  if (!unit.empty()) json["unit"] = {{"type", "MeasurementUnit"}, {"_label", unit}};
  return json;
}

// Adds a value to the list of a property.
void add(nlohmann::json& json, const char* property, nlohmann::json value) {
  json[property].push_back(std::move(value));
}

void add_statement(nlohmann::json& json, const std::string& label, const std::string& content,
                   const nlohmann::json& type = nullptr) {
  if (!content.empty()) add(json, "referred_to_by", statement(label, content, type));
}

// Returns the time-span of a year, a month or a day.
nlohmann::json time_span(const std::string& date) {
  const std::string year = date.substr(0, 4);
  nlohmann::json span{{"type", "TimeSpan"}, {"_label", date}};
  const auto from = [&](const std::string& day) {
    span["begin_of_the_begin"] = day + "T00:00:00Z";
  };
  const auto to = [&](const std::string& day) { span["end_of_the_end"] = day + "T23:59:59Z"; };
  if (date.size() == 4) {
    from(year + "-01-01");
    to(year + "-12-31");
  } else if (date.size() == 7) {
    const int month = std::stoi(date.substr(5, 2)), number = std::stoi(year);
    const bool is_leap = number % 4 == 0 && (number % 100 != 0 || number % 400 == 0);
    constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    const int days = month == 2 && is_leap ? 29 : kDays[month - 1];
    from(date + "-01");
    to(date + "-" + std::to_string(days));
  } else {
    from(date);
    to(date);
  }
  return span;
}

nlohmann::json object_reference(const LinkedAddresses& addresses, const Model& model) {
  return {{"id", addresses.object_of(model)}, {"type", "HumanMadeObject"}};
}

void add_object_facts(nlohmann::json& object, const Model& model) {
  if (!model.inventory_number.empty()) {
    nlohmann::json number{{"type", "Identifier"},
                          {"content", model.inventory_number},
                          {"classified_as", {aat_type(kAccessionNumber, "accession numbers")}}};
    const auto known = object.find("identified_by");
    if (known == object.end() || std::find(known->begin(), known->end(), number) == known->end())
      add(object, "identified_by", std::move(number));
  }
  if (!model.owner.empty()) {
    nlohmann::json owner = statement("Owner", model.owner);
    const auto known = object.find("referred_to_by");
    if (known == object.end() || std::find(known->begin(), known->end(), owner) == known->end())
      add(object, "referred_to_by", std::move(owner));
  }
}

std::string text_of(const Column& column, const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : print_value(column, value);
}

// Adds a value of a record that is no term, file or place.
void add_value(nlohmann::json& json, const Column& column, const nlohmann::json& value) {
  switch (column.kind) {
    case ColumnKind::integer:
    case ColumnKind::numeric:
      add(json, "dimension", dimension(column.name, value, column.unit));
      break;
    case ColumnKind::term:
    case ColumnKind::relation:
    case ColumnKind::picture:
    case ColumnKind::document:
    case ColumnKind::line:
    case ColumnKind::point: break;
    default: add_statement(json, column.name, text_of(column, value));
  }
}

nlohmann::json type_of(const LinkedAddresses& addresses, const RecordTerm& term) {
  nlohmann::json type{{"id", addresses.record(*term.column->target, term.key)},
                      {"type", "Type"},
                      {"_label", term.label}};
  if (is_iri(term.uri)) type["equivalent"] = {{{"id", term.uri}, {"type", "Type"}}};
  return type;
}

class RecordWriter {
 public:
  RecordWriter(const LinkedAddresses& addresses, const LinkedRecord& record)
      : addresses_(addresses),
        of_(record),
        id_(addresses.record(record.table.id, record.record.key)) {}

  nlohmann::json write() {
    json_ = {
        {"id", id_},
        {"type", "PhysicalFeature"},
        {"_label", of_.name.empty() ? std::to_string(of_.record.key) : of_.name},
        {"identified_by", nlohmann::json::array({{{"type", "Identifier"},
                                                  {"_label", "Key in " + of_.table.name},
                                                  {"content", std::to_string(of_.record.key)}}})},
        {"is_part_of", {{"id", addresses_.table(of_.table.id)}, {"_label", of_.table.name}}}};
    if (!of_.name.empty()) add(json_, "identified_by", name_of(of_.name));
    for (const Column& column : of_.table.columns)
      if (const auto value = of_.record.values.find(column.id);
          value != of_.record.values.end() && !value->second.is_null())
        write_value(column, value->second);
    write_condition();
    for (const RecordSite& site : of_.sites) write_site(site);
    for (const Attachment& file : of_.files) write_file(file);
    return std::move(json_);
  }

 private:
  void write_value(const Column& column, const nlohmann::json& value) {
    if (column.kind == ColumnKind::enumeration)
      choices_.push_back({{"type", "Type"}, {"_label", text_of(column, value)}});
    if (column.kind == ColumnKind::relation && column.target)
      for (const nlohmann::json& key : value)
        add(json_, "relation",
            {{"id", addresses_.record(*column.target, key.get<std::int64_t>())},
             {"_label", column.name}});
    add_value(json_, column, value);
  }

  void write_condition() {
    nlohmann::json types = choices_;
    for (const RecordTerm& term : of_.terms) types.push_back(type_of(addresses_, term));
    if (types.empty()) return;
    json_["classified_as"] = types;
    nlohmann::json assessment{{"id", id_ + "#assessment"}, {"type", "ConditionAssessment"}};
    std::set<std::string> objects;
    for (const RecordSite& site : of_.sites)
      if (objects.insert(addresses_.object_of(site.model)).second)
        add(assessment, "concerned", object_reference(addresses_, site.model));
    if (!of_.author.empty())
      assessment["carried_out_by"] =
          nlohmann::json::array({{{"type", "Person"}, {"_label", of_.author}}});
    if (!of_.time.empty())
      assessment["timespan"] = {
          {"type", "TimeSpan"}, {"begin_of_the_begin", of_.time}, {"end_of_the_end", of_.time}};
    json_["has_condition"] = {{"id", id_ + "#condition"},
                              {"type", "ConditionState"},
                              {"_label", json_.at("_label")},
                              {"classified_as", std::move(types)},
                              {"was_identified_by", std::move(assessment)}};
  }

  void write_site(const RecordSite& site) {
    const auto object = object_reference(addresses_, site.model);
    if (!json_.contains("found_on") || std::find(json_["found_on"].begin(), json_["found_on"].end(),
                                                 object) == json_["found_on"].end())
      add(json_, "found_on", object);
    nlohmann::json place{{"type", "Place"}, {"_label", site.label}};
    if (!site.wkt.empty()) place["defined_by"] = site.wkt;
    if (!site.annotation.empty()) {
      place["id"] = site.annotation + "#place";
      add(place, "subject_of",
          digital(site.annotation, "Annotation with the outline", "application/ld+json"));
    }
    add(json_, "occupies", std::move(place));
    if (site.area_m2)
      add(json_, "dimension", dimension("Area, " + site.label, *site.area_m2, "m²"));
  }

  void write_file(const Attachment& file) {
    add(json_, "subject_of",
        digital(addresses_.site() + "/api/v1/attachments/" + to_string(file.id), file.name,
                file.media_type.c_str()));
  }

  const LinkedAddresses& addresses_;
  const LinkedRecord& of_;
  const std::string id_;
  nlohmann::json json_, choices_ = nlohmann::json::array();
};

}  // namespace

nlohmann::json linked_model(const LinkedAddresses& addresses, const Model& model,
                            const std::vector<Layer>& layers, bool with_source) {
  const std::string id = addresses.model(model.id);
  nlohmann::json json{
      {"id", id},
      {"type", "DigitalObject"},
      {"_label", model.name},
      {"identified_by", nlohmann::json::array({name_of(model.name)})},
      {"dimension",
       {dimension("Surface", model.area_m2(), "m²"), dimension("Triangles", model.triangles, {})}},
      {"subject_of",
       {digital(addresses.manifest(model.id), "IIIF manifest", "application/ld+json"),
        digital(addresses.annotations(model.id), "Annotations", "application/ld+json"),
        digital(addresses.gis(model), "Collection for GIS programs", "application/json"),
        digital(addresses.page(model), "Page", "text/html")}}};
  json["subject_of"][0]["conforms_to"] = {{"id", "http://iiif.io/api/presentation/4/context.json"},
                                          {"type", "InformationObject"}};
  add_statement(json, "Method", model.method);
  add_statement(json, "Accuracy", model.accuracy);
  add_statement(json, "Processing", model.processing);
  add_statement(json, "Credit", model.credit, aat_type(kCreditLine, "credit line"));
  add_statement(json, "Rights", model.rights_uri,
                aat_type(kLicence, "copyright/licensing statement"));
  if (!model.crs.empty()) add_statement(json, "Coordinate system", model.crs);
  if (with_source)
    for (const SourceFile& file : model.source_files)
      add(json, "access_point",
          {{"id", addresses.api(model) + "/source/" + percent_encode(file.name)},
           {"type", "DigitalObject"},
           {"_label", file.name}});
  nlohmann::json creation{{"type", "Creation"}};
  add_statement(creation, "Creator", model.creator);
  add_statement(creation, "Captured", model.captured);
  if (!model.survey_date.empty()) creation["timespan"] = time_span(model.survey_date);
  if (creation.size() > 1) json["created_by"] = std::move(creation);
  nlohmann::json object = object_reference(addresses, model);
  if (!model.object) {
    object["_label"] = model.name;
    add_object_facts(object, model);
  }
  json["digitally_shows"] =
      nlohmann::json::array({{{"id", id + "#shape"},
                              {"type", "VisualItem"},
                              {"_label", "Shape and color of " + model.name},
                              {"represents", nlohmann::json::array({std::move(object)})}}});
  for (const Layer& layer : layers)
    add(json, "has_part",
        {{"id", addresses.layer(layer)}, {"type", "DigitalObject"}, {"_label", layer.name}});
  return json;
}

nlohmann::json linked_object(const LinkedAddresses& addresses, const SurveyedObject& object,
                             const std::vector<Model>& models) {
  nlohmann::json json{{"id", addresses.object(object.project_id, object.id)},
                      {"type", "HumanMadeObject"},
                      {"_label", object.name},
                      {"identified_by", nlohmann::json::array({name_of(object.name)})}};
  for (const Model& model : models) {
    add_object_facts(json, model);
    add(json, "representation",
        {{"id", addresses.model(model.id) + "#shape"},
         {"type", "VisualItem"},
         {"_label", "Shape and color of " + model.name},
         {"digitally_shown_by", nlohmann::json::array({{{"id", addresses.model(model.id)},
                                                        {"type", "DigitalObject"},
                                                        {"_label", model.name}}})}});
  }
  return json;
}

nlohmann::json linked_layer(const LinkedAddresses& addresses, const Model& model,
                            const Layer& layer) {
  const std::string api = addresses.api(model) + "/layers/" + layer.slug;
  nlohmann::json json{
      {"id", addresses.layer(layer)},
      {"type", "DigitalObject"},
      {"_label", layer.name},
      {"identified_by", nlohmann::json::array({name_of(layer.name)})},
      {"is_part_of",
       {{"id", addresses.model(model.id)}, {"type", "DigitalObject"}, {"_label", model.name}}},
      {"access_point",
       {digital(api + "/texels.tif", "Values on the surface", "image/tiff"),
        digital(api + "/features", "Areas, lines and points", "application/geo+json"),
        digital(addresses.gis(model, layer) + "/coverage?f=tiff", "Values on a plane",
                "image/tiff")}},
      {"subject_of",
       {digital(addresses.annotations(layer), "Annotations", "application/ld+json"),
        digital(addresses.gis(model, layer), "Collection for GIS programs", "application/json")}}};
  for (const auto& [language, label] : layer.labels) add(json, "identified_by", name_of(label));
  add_statement(json, "Description", layer.description, aat_type(kDescription, "description"));
  if (!layer.unit.empty()) add_statement(json, "Unit of the values", layer.unit);
  if (layer.formula) add_statement(json, "Formula", layer.formula->expression);
  if (layer.table) add(json, "relation", {{"id", addresses.table(*layer.table)}});
  return json;
}

nlohmann::json linked_record(const LinkedAddresses& addresses, const LinkedRecord& record) {
  return RecordWriter(addresses, record).write();
}

}  // namespace strata::net
