#include "query/maps/flat_area.h"

#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <string>

#include "domain/people/question.h"

namespace strata::query {
namespace {

constexpr int kMaxGrids = 6;  // each is twice as coarse as the previous one

// The GEOS context of this thread. GEOS objects do not depend on a context, so any thread may use
// them.
class Context {
 public:
  Context() : handle_(GEOS_init_r()) {
    static std::once_flag once;
    // GEOS calls this function during long operations. An exception from it ends the operation.
    std::call_once(once, [] { GEOS_interruptRegisterCallback(&check_question); });
    GEOSContext_setErrorMessageHandler_r(
        handle_,
        [](const char* message, void* context) {
          static_cast<Context*>(context)->message_ = message;
        },
        this);
  }
  ~Context() { GEOS_finish_r(handle_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  GEOSContextHandle_t handle() const { return handle_; }
  [[noreturn]] void give_up() const {
    check_question();
    throw std::runtime_error("GEOS: " + message_);
  }

 private:
  GEOSContextHandle_t handle_;
  std::string message_;
};

Context& context() {
  thread_local Context of_thread;
  return of_thread;
}
GEOSContextHandle_t geos() { return context().handle(); }

struct Destroy {
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(geos(), geometry); }
};
using Owned = std::unique_ptr<GEOSGeometry, Destroy>;

Owned owned(GEOSGeometry* geometry) {
  if (!geometry) context().give_up();
  return Owned(geometry);
}

Owned closed_ring(const FlatRing& ring) {
  std::vector<double> numbers;
  numbers.reserve(3 * (ring.size() + 1));
  for (std::size_t i = 0; i <= ring.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) numbers.push_back(ring[i % ring.size()][axis]);
  GEOSCoordSequence* corners = GEOSCoordSeq_copyFromBuffer_r(
      geos(), numbers.data(), static_cast<unsigned>(ring.size() + 1), 1, 0);
  if (!corners) context().give_up();
  return owned(GEOSGeom_createLinearRing_r(geos(), corners));
}

// Removes the lines and points that result where areas only touch.
Owned areas_alone(Owned geometry) {
  const int type = GEOSGeomTypeId_r(geos(), geometry.get());
  if (type == GEOS_POLYGON || type == GEOS_MULTIPOLYGON) return geometry;
  std::vector<GEOSGeometry*> areas;
  const int count = GEOSGetNumGeometries_r(geos(), geometry.get());
  for (int i = 0; type == GEOS_GEOMETRYCOLLECTION && i < count; ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(geos(), geometry.get(), i);
    const int of_part = GEOSGeomTypeId_r(geos(), part);
    if (of_part == GEOS_POLYGON) areas.push_back(GEOSGeom_clone_r(geos(), part));
    for (int k = 0; of_part == GEOS_MULTIPOLYGON && k < GEOSGetNumGeometries_r(geos(), part); ++k)
      areas.push_back(GEOSGeom_clone_r(geos(), GEOSGetGeometryN_r(geos(), part, k)));
  }
  return owned(GEOSGeom_createCollection_r(geos(), GEOS_MULTIPOLYGON, areas.data(),
                                           static_cast<unsigned>(areas.size())));
}

Owned made_valid(Owned polygon) {
  if (GEOSisValid_r(geos(), polygon.get()) == 1) return polygon;
  struct Params {
    GEOSMakeValidParams* params = GEOSMakeValidParams_create_r(geos());
    ~Params() { GEOSMakeValidParams_destroy_r(geos(), params); }
  } const made;
  // Keeps regions that rings enclose twice, because a surface that folds over itself covers them.
  GEOSMakeValidParams_setMethod_r(geos(), made.params, GEOS_MAKE_VALID_STRUCTURE);
  return areas_alone(owned(GEOSMakeValidWithParams_r(geos(), polygon.get(), made.params)));
}

FlatRing ring_of(const GEOSGeometry* line, bool counter_clockwise) {
  const GEOSCoordSequence* corners = GEOSGeom_getCoordSeq_r(geos(), line);
  unsigned count = 0;
  if (!corners || !GEOSCoordSeq_getSize_r(geos(), corners, &count)) context().give_up();
  std::vector<double> numbers(std::size_t{3} * count);
  if (!GEOSCoordSeq_copyToBuffer_r(geos(), corners, numbers.data(), 1, 0)) context().give_up();
  FlatRing ring;
  for (unsigned i = 0; i + 1 < count; ++i) {
    const double z = numbers[3 * i + 2];
    ring.emplace_back(numbers[3 * i], numbers[3 * i + 1], std::isfinite(z) ? z : 0);
  }
  if ((ring_area(ring) > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace

double ring_area(const FlatRing& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    // Coordinates are relative to the first corner, so that large coordinates do not reduce
    // precision.
    const glm::dvec3 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    twice += a.x * b.y - b.x * a.y;
  }
  return twice / 2;
}

struct FlatArea::Held {
  Owned geometry;
};

FlatArea::FlatArea()
    : held_(std::make_unique<Held>(owned(GEOSGeom_createEmptyPolygon_r(geos())))) {}
FlatArea::FlatArea(std::unique_ptr<Held> held) : held_(std::move(held)) {}
FlatArea::FlatArea(FlatArea&&) noexcept = default;
FlatArea& FlatArea::operator=(FlatArea&&) noexcept = default;
FlatArea::~FlatArea() = default;

FlatArea::FlatArea(const FlatPolygon& polygon) {
  std::vector<Owned> rings;
  for (const FlatRing& ring : polygon.rings)
    if (ring.size() >= 3) rings.push_back(closed_ring(ring));
  if (rings.empty()) {
    *this = FlatArea();
    return;
  }
  GEOSGeometry* shell = rings.front().release();
  std::vector<GEOSGeometry*> holes;
  for (std::size_t i = 1; i < rings.size(); ++i) holes.push_back(rings[i].release());
  held_ = std::make_unique<Held>(made_valid(owned(
      GEOSGeom_createPolygon_r(geos(), shell, holes.data(), static_cast<unsigned>(holes.size())))));
}

bool FlatArea::is_empty() const { return GEOSisEmpty_r(geos(), held_->geometry.get()) != 0; }

double FlatArea::area() const {
  double area = 0;
  if (!GEOSArea_r(geos(), held_->geometry.get(), &area)) context().give_up();
  return area;
}

FlatArea FlatArea::cut_with(const FlatArea& other) const {
  return FlatArea(std::make_unique<Held>(areas_alone(
      owned(GEOSIntersection_r(geos(), held_->geometry.get(), other.held_->geometry.get())))));
}

FlatArea FlatArea::joined(std::vector<FlatArea> areas, double grid) {
  std::vector<GEOSGeometry*> parts;
  for (FlatArea& area : areas)
    if (!area.is_empty()) parts.push_back(area.held_->geometry.release());
  const Owned all = owned(GEOSGeom_createCollection_r(geos(), GEOS_GEOMETRYCOLLECTION, parts.data(),
                                                      static_cast<unsigned>(parts.size())));
  // In rare cases GEOS fails for coincident lines on one grid, but not on a coarser one.
  for (int tries = 1;; ++tries, grid *= 2) {
    try {
      return FlatArea(std::make_unique<Held>(
          areas_alone(owned(GEOSUnaryUnionPrec_r(geos(), all.get(), grid)))));
    } catch (const std::runtime_error&) {
      if (tries == kMaxGrids) throw;
    }
  }
}

FlatArea FlatArea::simplified(double distance) const {
  return FlatArea(std::make_unique<Held>(
      made_valid(owned(GEOSTopologyPreserveSimplify_r(geos(), held_->geometry.get(), distance)))));
}

std::vector<FlatPolygon> FlatArea::polygons() const {
  std::vector<FlatPolygon> polygons;
  const int count = GEOSGetNumGeometries_r(geos(), held_->geometry.get());
  for (int i = 0; i < count; ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(geos(), held_->geometry.get(), i);
    if (GEOSisEmpty_r(geos(), part) != 0) continue;
    FlatPolygon& polygon = polygons.emplace_back();
    polygon.rings.push_back(ring_of(GEOSGetExteriorRing_r(geos(), part), true));
    const int holes = GEOSGetNumInteriorRings_r(geos(), part);
    for (int k = 0; k < holes; ++k)
      polygon.rings.push_back(ring_of(GEOSGetInteriorRingN_r(geos(), part, k), false));
  }
  return polygons;
}

struct FlatAreaTree::Held {
  GEOSSTRtree* tree = GEOSSTRtree_create_r(geos(), 10);
  ~Held() { GEOSSTRtree_destroy_r(geos(), tree); }
};

FlatAreaTree::FlatAreaTree(const std::vector<FlatArea>& areas) : held_(std::make_unique<Held>()) {
  for (const FlatArea& area : areas)
    if (!area.is_empty())
      GEOSSTRtree_insert_r(geos(), held_->tree, area.held_->geometry.get(),
                           const_cast<FlatArea*>(&area));
}
FlatAreaTree::~FlatAreaTree() = default;

void FlatAreaTree::find(const FlatArea& area,
                        const std::function<void(const FlatArea&)>& visit) const {
  std::vector<const FlatArea*> found;
  GEOSSTRtree_query_r(
      geos(), held_->tree, area.held_->geometry.get(),
      [](void* item, void* list) {
        static_cast<std::vector<const FlatArea*>*>(list)->push_back(
            static_cast<const FlatArea*>(item));
      },
      &found);
  for (const FlatArea* each : found) visit(*each);
}

}  // namespace strata::query
