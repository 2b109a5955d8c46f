#include "net/api/linked/linked_terms.h"

namespace strata::net {
namespace {

using Kind = LinkedKind;
constexpr bool kOwn = true;

const RdfPrefix kPrefixes[] = {
    {"as", "http://www.w3.org/ns/activitystreams#"},
    {"crm", "http://www.cidoc-crm.org/cidoc-crm/"},
    {"dc", "http://purl.org/dc/elements/1.1/"},
    {"dcat", "http://www.w3.org/ns/dcat#"},
    {"dcterms", "http://purl.org/dc/terms/"},
    {"dctypes", "http://purl.org/dc/dcmitype/"},
    {"dig", "http://www.ics.forth.gr/isl/CRMdig/"},
    {"foaf", "http://xmlns.com/foaf/0.1/"},
    {"hydra", "http://www.w3.org/ns/hydra/core#"},
    {"iiif", "http://iiif.io/api/presentation/4#"},
    {"la", "https://linked.art/ns/terms/"},
    {"oa", "http://www.w3.org/ns/oa#"},
    {"rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#"},
    {"rdfs", "http://www.w3.org/2000/01/rdf-schema#"},
    {"skos", "http://www.w3.org/2004/02/skos/core#"},
    {"xsd", "http://www.w3.org/2001/XMLSchema#"},
};

constexpr LinkedTerm kLinkedArt[] = {
    {"Creation", "crm:E65_Creation", Kind::type},
    {"DigitalObject", "dig:D1_Digital_Object", Kind::type},
    {"Dimension", "crm:E54_Dimension", Kind::type},
    {"HumanMadeObject", "crm:E22_Human-Made_Object", Kind::type},
    {"Identifier", "crm:E42_Identifier", Kind::type},
    {"InformationObject", "crm:E73_Information_Object", Kind::type},
    {"LinguisticObject", "crm:E33_Linguistic_Object", Kind::type},
    {"MeasurementUnit", "crm:E58_Measurement_Unit", Kind::type},
    {"Name", "crm:E33_E41_Linguistic_Appellation", Kind::type},
    {"Person", "crm:E21_Person", Kind::type},
    {"Place", "crm:E53_Place", Kind::type},
    {"TimeSpan", "crm:E52_Time-Span", Kind::type},
    {"Type", "crm:E55_Type", Kind::type},
    {"VisualItem", "crm:E36_Visual_Item", Kind::type},
    {"_label", "rdfs:label", Kind::text},
    {"access_point", "la:access_point", Kind::node},
    {"begin_of_the_begin", "crm:P82a_begin_of_the_begin", Kind::time},
    {"carried_out_by", "crm:P14_carried_out_by", Kind::node},
    {"classified_as", "crm:P2_has_type", Kind::node},
    {"conforms_to", "dcterms:conformsTo", Kind::node},
    {"content", "crm:P190_has_symbolic_content", Kind::text},
    {"created_by", "crm:P94i_was_created_by", Kind::node},
    {"defined_by", "crm:P168_place_is_defined_by", Kind::text},
    {"digitally_shown_by", "la:digitally_shown_by", Kind::node},
    {"digitally_shows", "la:digitally_shows", Kind::node},
    {"dimension", "crm:P43_has_dimension", Kind::node},
    {"end_of_the_end", "crm:P82b_end_of_the_end", Kind::time},
    {"equivalent", "la:equivalent", Kind::node},
    {"format", "dc:format", Kind::text},
    {"identified_by", "crm:P1_is_identified_by", Kind::node},
    {"referred_to_by", "crm:P67i_is_referred_to_by", Kind::node},
    {"representation", "crm:P138i_has_representation", Kind::node},
    {"represents", "crm:P138_represents", Kind::node},
    {"subject_of", "crm:P129i_is_subject_of", Kind::node},
    {"timespan", "crm:P4_has_time-span", Kind::node},
    {"unit", "crm:P91_has_unit", Kind::node},
    {"value", "crm:P90_has_value", Kind::text},
    {"ConditionAssessment", "crm:E14_Condition_Assessment", Kind::type, kOwn},
    {"ConditionState", "crm:E3_Condition_State", Kind::type, kOwn},
    {"PhysicalFeature", "crm:E26_Physical_Feature", Kind::type, kOwn},
    {"concerned", "crm:P34_concerned", Kind::node, kOwn},
    {"found_on", "crm:P56i_is_found_on", Kind::node, kOwn},
    {"has_condition", "crm:P44_has_condition", Kind::node, kOwn},
    {"has_part", "dcterms:hasPart", Kind::node, kOwn},
    {"is_part_of", "dcterms:isPartOf", Kind::node, kOwn},
    {"occupies", "crm:P156_occupies", Kind::node, kOwn},
    {"relation", "dcterms:relation", Kind::node, kOwn},
    {"was_identified_by", "crm:P35i_was_identified_by", Kind::node, kOwn},
};

constexpr LinkedTerm kWebAnnotation[] = {
    {"Annotation", "oa:Annotation", Kind::type},
    {"AnnotationCollection", "as:OrderedCollection", Kind::type},
    {"AnnotationPage", "as:OrderedCollectionPage", Kind::type},
    {"Dataset", "dctypes:Dataset", Kind::type},
    {"Image", "dctypes:StillImage", Kind::type},
    {"Person", "foaf:Person", Kind::type},
    {"SpecificResource", "oa:SpecificResource", Kind::type},
    {"TextualBody", "oa:TextualBody", Kind::type},
    {"body", "oa:hasBody", Kind::node},
    {"commenting", "oa:commenting", Kind::type},
    {"created", "dcterms:created", Kind::time},
    {"creator", "dcterms:creator", Kind::node},
    {"describing", "oa:describing", Kind::type},
    {"first", "as:first", Kind::node},
    {"format", "dc:format", Kind::text},
    {"identifying", "oa:identifying", Kind::type},
    {"items", "as:items", Kind::list},
    {"label", "rdfs:label", Kind::text},
    {"modified", "dcterms:modified", Kind::time},
    {"motivation", "oa:motivatedBy", Kind::word},
    {"name", "foaf:name", Kind::text},
    {"next", "as:next", Kind::node},
    {"partOf", "as:partOf", Kind::node},
    {"prev", "as:prev", Kind::node},
    {"purpose", "oa:hasPurpose", Kind::word},
    {"replying", "oa:replying", Kind::type},
    {"selector", "oa:hasSelector", Kind::node},
    {"source", "oa:hasSource", Kind::node},
    {"startIndex", "as:startIndex", Kind::count},
    {"tagging", "oa:tagging", Kind::type},
    {"target", "oa:hasTarget", Kind::node},
    {"value", "rdf:value", Kind::text},
    {"Manifest", "iiif:Manifest", Kind::type, kOwn},
    {"PointSelector", "iiif:PointSelector", Kind::type, kOwn},
    {"Scene", "iiif:Scene", Kind::type, kOwn},
    {"WktSelector", "iiif:WktSelector", Kind::type, kOwn},
    {"seeAlso", "rdfs:seeAlso", Kind::node, kOwn},
    {"x", "iiif:x", Kind::text, kOwn},
    {"y", "iiif:y", Kind::text, kOwn},
    {"z", "iiif:z", Kind::text, kOwn},
};

constexpr LinkedTerm kCatalog[] = {
    {"Catalog", "dcat:Catalog", Kind::type, kOwn},
    {"Concept", "skos:Concept", Kind::type, kOwn},
    {"ConceptScheme", "skos:ConceptScheme", Kind::type, kOwn},
    {"Dataset", "dcat:Dataset", Kind::type, kOwn},
    {"Distribution", "dcat:Distribution", Kind::type, kOwn},
    {"access_url", "dcat:accessURL", Kind::node, kOwn},
    {"broader", "skos:broader", Kind::node, kOwn},
    {"conforms_to", "dcterms:conformsTo", Kind::node, kOwn},
    {"dataset", "dcat:dataset", Kind::node, kOwn},
    {"definition", "skos:definition", Kind::text, kOwn},
    {"description", "dcterms:description", Kind::text, kOwn},
    {"distribution", "dcat:distribution", Kind::node, kOwn},
    {"exact_match", "skos:exactMatch", Kind::node, kOwn},
    {"format", "dc:format", Kind::text, kOwn},
    {"has_part", "dcterms:hasPart", Kind::node, kOwn},
    {"has_top_concept", "skos:hasTopConcept", Kind::node, kOwn},
    {"identifier", "dcterms:identifier", Kind::text, kOwn},
    {"in_scheme", "skos:inScheme", Kind::node, kOwn},
    {"landing_page", "dcat:landingPage", Kind::node, kOwn},
    {"next", "hydra:next", Kind::node, kOwn},
    {"notation", "skos:notation", Kind::text, kOwn},
    {"preferred_label", "skos:prefLabel", Kind::text, kOwn},
    {"previous", "hydra:previous", Kind::node, kOwn},
    {"rights", "dcterms:rights", Kind::text, kOwn},
    {"title", "dcterms:title", Kind::text, kOwn},
    {"top_concept_of", "skos:topConceptOf", Kind::node, kOwn},
};

}  // namespace

const LinkedContext& linked_art() {
  static const LinkedContext context{"https://linked.art/ns/v1/linked-art.json", kLinkedArt,
                                     kPrefixes};
  return context;
}

const LinkedContext& web_annotation() {
  static const LinkedContext context{"http://www.w3.org/ns/anno.jsonld", kWebAnnotation, kPrefixes};
  return context;
}

const LinkedContext& catalog_terms() {
  static const LinkedContext context{{}, kCatalog, kPrefixes};
  return context;
}

nlohmann::json aat_type(const char* number, const char* label) {
  return {{"id", std::string("http://vocab.getty.edu/aat/") + number},
          {"type", "Type"},
          {"_label", label}};
}

nlohmann::json statement(const std::string& label, const std::string& content,
                         const nlohmann::json& type) {
  nlohmann::json json{{"type", "LinguisticObject"}, {"_label", label}, {"content", content}};
  if (!type.is_null()) json["classified_as"] = {type};
  return json;
}

}  // namespace strata::net
