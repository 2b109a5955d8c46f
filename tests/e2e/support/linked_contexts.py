"""The contexts of JSON-LD that the server refers to, as far as the tests need them, and graphs of
documents. The entries follow the published contexts: https://linked.art/ns/v1/linked-art.json and
http://www.w3.org/ns/anno.jsonld."""
import json

from .missing import missing

try:
    import rdflib
    from rdflib.compare import to_isomorphic
except ImportError:
    rdflib = None

CRM = "http://www.cidoc-crm.org/cidoc-crm/"
LA = "https://linked.art/ns/terms/"
OA = "http://www.w3.org/ns/oa#"
AS = "http://www.w3.org/ns/activitystreams#"
DCTERMS = "http://purl.org/dc/terms/"
XSD = "http://www.w3.org/2001/XMLSchema#"
RDFS = "http://www.w3.org/2000/01/rdf-schema#"


def _link(iri):
    return {"@id": iri, "@type": "@id"}


def _set(iri):
    return {**_link(iri), "@container": "@set"}


def _typed(iri, name):
    return {"@id": iri, "@type": XSD + name}


LINKED_ART = {
    "id": "@id",
    "type": "@type",
    "_label": RDFS + "label",
    "Creation": CRM + "E65_Creation",
    "DigitalObject": "http://www.ics.forth.gr/isl/CRMdig/D1_Digital_Object",
    "Dimension": CRM + "E54_Dimension",
    "HumanMadeObject": CRM + "E22_Human-Made_Object",
    "Identifier": CRM + "E42_Identifier",
    "InformationObject": CRM + "E73_Information_Object",
    "LinguisticObject": CRM + "E33_Linguistic_Object",
    "MeasurementUnit": CRM + "E58_Measurement_Unit",
    "Name": CRM + "E33_E41_Linguistic_Appellation",
    "Person": CRM + "E21_Person",
    "Place": CRM + "E53_Place",
    "TimeSpan": CRM + "E52_Time-Span",
    "Type": CRM + "E55_Type",
    "VisualItem": CRM + "E36_Visual_Item",
    "access_point": _set(LA + "access_point"),
    "begin_of_the_begin": _typed(CRM + "P82a_begin_of_the_begin", "dateTime"),
    "end_of_the_end": _typed(CRM + "P82b_end_of_the_end", "dateTime"),
    "carried_out_by": _set(CRM + "P14_carried_out_by"),
    "classified_as": _set(CRM + "P2_has_type"),
    "conforms_to": _set(DCTERMS + "conformsTo"),
    "content": CRM + "P190_has_symbolic_content",
    "created_by": _link(CRM + "P94i_was_created_by"),
    "defined_by": CRM + "P168_place_is_defined_by",
    "digitally_shown_by": _set(LA + "digitally_shown_by"),
    "digitally_shows": _set(LA + "digitally_shows"),
    "dimension": _set(CRM + "P43_has_dimension"),
    "equivalent": _set(LA + "equivalent"),
    "format": "http://purl.org/dc/elements/1.1/format",
    "identified_by": _set(CRM + "P1_is_identified_by"),
    "referred_to_by": _set(CRM + "P67i_is_referred_to_by"),
    "representation": _set(CRM + "P138i_has_representation"),
    "represents": _set(CRM + "P138_represents"),
    "subject_of": _set(CRM + "P129i_is_subject_of"),
    "timespan": _link(CRM + "P4_has_time-span"),
    "unit": _link(CRM + "P91_has_unit"),
    "value": CRM + "P90_has_value",
}

WEB_ANNOTATION = {
    "id": "@id",
    "type": "@type",
    "Annotation": OA + "Annotation",
    "AnnotationCollection": AS + "OrderedCollection",
    "AnnotationPage": AS + "OrderedCollectionPage",
    "Dataset": "http://purl.org/dc/dcmitype/Dataset",
    "Image": "http://purl.org/dc/dcmitype/StillImage",
    "Person": "http://xmlns.com/foaf/0.1/Person",
    "SpecificResource": OA + "SpecificResource",
    "TextualBody": OA + "TextualBody",
    "body": _link(OA + "hasBody"),
    "commenting": OA + "commenting",
    "created": _typed(DCTERMS + "created", "dateTime"),
    "creator": _link(DCTERMS + "creator"),
    "describing": OA + "describing",
    "first": _link(AS + "first"),
    "format": "http://purl.org/dc/elements/1.1/format",
    "items": {**_link(AS + "items"), "@container": "@list"},
    "label": RDFS + "label",
    "modified": _typed(DCTERMS + "modified", "dateTime"),
    "motivation": {"@id": OA + "motivatedBy", "@type": "@vocab"},
    "name": "http://xmlns.com/foaf/0.1/name",
    "next": _link(AS + "next"),
    "partOf": _link(AS + "partOf"),
    "prev": _link(AS + "prev"),
    "purpose": {"@id": OA + "hasPurpose", "@type": "@vocab"},
    "replying": OA + "replying",
    "selector": _link(OA + "hasSelector"),
    "source": _link(OA + "hasSource"),
    "tagging": OA + "tagging",
    "target": _link(OA + "hasTarget"),
    "value": "http://www.w3.org/1999/02/22-rdf-syntax-ns#value",
}
PUBLISHED = {
    "https://linked.art/ns/v1/linked-art.json": LINKED_ART,
    "http://www.w3.org/ns/anno.jsonld": WEB_ANNOTATION,
}


def local_context(context):
    """Returns a context in which published contexts are replaced with their entries."""
    if isinstance(context, list):
        return [local_context(each) for each in context]
    return PUBLISHED[context] if isinstance(context, str) else context


def json_ld_graph(document):
    if rdflib is None:
        missing("python3-rdflib is not installed")
    document = {**document, "@context": local_context(document["@context"])}
    return rdflib.Graph().parse(data=json.dumps(document), format="json-ld")


def turtle_graph(text):
    if rdflib is None:
        missing("python3-rdflib is not installed")
    return rdflib.Graph().parse(data=text, format="turtle")


def comparable(graph):
    """Returns the graph with numbers in one form, for comparison apart from names of blank nodes.
    JSON-LD reads 12.0 as an integer (JSON-LD 1.1 API, 8.4.2), and rdflib as a double."""
    same = rdflib.Graph()
    for subject, predicate, value in graph:
        if isinstance(value, rdflib.Literal) and str(value.datatype) == XSD + "double":
            number = float(value)
            value = rdflib.Literal(int(number) if number.is_integer() else number)
        same.add((subject, predicate, value))
    return to_isomorphic(same)
