#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/scene/model_part.h"

namespace strata {

struct Project {
  ProjectId id = 0;
  std::string name;
  std::string slug;
  std::string description;
  std::int64_t version = 1;
  // A request that changes an entity with a version must contain the version in If-Match.
  bool require_if_match = false;
};

enum class Unit { mm, cm, m };
double metres_per(Unit unit);
std::string_view name(Unit unit);
std::optional<Unit> parse_unit(std::string_view name);

// Facts about the atlas, for the response to GET /models/{model}.
struct AtlasReport {
  // The surface area per texel of a layer. It determines the precision of painting.
  struct TexelSize {
    int resolution = 0;
    double area_mean = 0, area_max = 0;  // unit²
  };
  // A reason why less than 60 % of the texels are used. `code` is stable, and `text` is for users.
  struct Limit {
    std::string code;  // "long_triangles", "many_charts", "hollow_charts", "file_coordinates"
    std::string text;
  };
  // "file": the UVs of the scan were kept; "made": the server unwrapped the mesh
  std::string source;
  int lowest_resolution = 2048;
  int charts = 0;
  double coverage = 0;  // fraction of texels on the surface, at lowest_resolution
  // The fraction of covered texels in two or more triangles, at lowest_resolution.
  double overlap = 0;
  double stretch_mean = 0;  // surface area per uv area, relative to the mean, area-weighted
  double stretch_p99 = 0;
  // The largest surface area of one texel at lowest_resolution, in unit².
  double texel_area_max = 0;
  // Ascending from lowest_resolution. Empty for models imported before the sizes were measured.
  std::vector<TexelSize> texel_sizes;
  // Empty if 60 % or more of the texels are used, and in older models.
  std::vector<Limit> limits{};
};

// The source of a proposed unit or up direction.
enum class ScaleReason { given, format, comment, coordinates, size, shape, parts };
std::string_view name(ScaleReason reason);
std::optional<ScaleReason> parse_scale_reason(std::string_view name);

// The unit and up direction that a file states or suggests (mesh/repair/scale_proposal.h).
struct ScaleProposal {
  Unit unit = Unit::m;
  ScaleReason unit_reason = ScaleReason::size;
  double unit_confidence = 1;  // 0…1
  std::string unit_comment;    // the comment that contains the unit
  std::string up = "z";        // one of kUpDirections
  ScaleReason up_reason = ScaleReason::shape;
  double up_confidence = 1;
  std::string up_comment;
};
nlohmann::json to_json(const ScaleProposal& proposal);
// Reads the stored form.
std::optional<ScaleProposal> scale_proposal_from_json(const nlohmann::json& json);

struct Repair {
  std::string what;  // "dropped degenerate faces"
  std::uint64_t count = 0;
};

// The borders of the surface: loops of edges that belong to only one triangle. They are rims of
// holes and of parts that were not scanned. A closed surface has no open edges.
struct OpenEdges {
  static constexpr std::size_t kMaxListed = 16;
  std::uint64_t loops = 0;
  double length = 0;  // total length of all loops, in units
  // The lengths of single loops in units, longest first, at most kMaxListed.
  std::vector<double> longest;
};
nlohmann::json to_json(const OpenEdges& edges, double metres_per_unit);
// Reads the stored form, where metres_per_unit is 1.
std::optional<OpenEdges> open_edges_from_json(const nlohmann::json& json);

// How the surface of a model was made from a point cloud at import. Lengths are in units.
struct SurfaceFromPoints {
  std::uint64_t points = 0;                     // in the file
  std::uint64_t used = 0;                       // after thinning
  double point_spacing = 0;                     // the median distance of a point to the next one
  double cell = 0;                              // the longest edge of the finest triangles, about
  double gap = 0;                               // the widest gap between points that was closed
  double distance_median = 0, distance_95 = 0;  // of the points to the surface
};
nlohmann::json to_json(const SurfaceFromPoints& facts, double metres_per_unit);
// Reads the stored form, where metres_per_unit is 1.
std::optional<SurfaceFromPoints> surface_from_points_from_json(const nlohmann::json& json);

struct SourceFile {
  std::string name;
  std::string sha256;  // in lowercase hex
  std::uint64_t bytes = 0;
};

struct Model {
  ModelId id = 0;
  ProjectId project_id = 0;
  std::string name;
  std::string slug;
  Unit unit = Unit::m;
  bool unit_assumed = true;
  bool scale_verified = false;
  std::string up = "z";  // one of kUpDirections (domain/scene/up.h)
  // Models that were imported before proposals existed have no proposal.
  std::optional<ScaleProposal> proposal;
  std::string north;     // free text: degrees from +y, or empty
  std::string crs;       // "EPSG:n" or empty
  glm::dvec3 origin{0};  // model space is the world minus this position
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  glm::dvec3 bounds_min{0};  // in world coordinates
  glm::dvec3 bounds_max{0};
  double area = 0;  // unit²
  AtlasReport atlas;
  std::vector<Repair> repairs;
  // nullopt for models that were imported before the edges were measured.
  std::optional<OpenEdges> open_edges;
  std::optional<SurfaceFromPoints> from_points;  // nullopt: the file contained triangles
  std::vector<ModelPart> parts;                  // empty: the model was imported from one scan
  std::vector<SourceFile> source_files;
  // The lowest role that may get the source files or equivalent data.
  Role source_download = Role::annotator;
  int default_resolution = 2048;  // of new layers
  std::string inventory_number, owner, creator, captured, method, accuracy, processing, rights_uri,
      credit;
  // The object of which the model is a survey, and the date of the survey (domain/scene/
  // surveyed_object.h). A model has both or neither.
  std::optional<ObjectId> object;
  std::string survey_date;
  std::int64_t sequence = 0;  // of the last journal entry
  std::int64_t version = 1;

  double metres() const { return metres_per(unit); }
  double area_m2() const { return area * metres() * metres(); }
};

nlohmann::json to_json(const Project& project);
nlohmann::json to_json(const Model& model, const std::string& project_slug);
nlohmann::json to_json(const AtlasReport& atlas, double metres_per_unit);
AtlasReport atlas_from_json(const nlohmann::json& json);  // reads the stored form, see store

}  // namespace strata
