#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "render/view/depth_copy.h"

namespace strata::bench {

// The scene that all methods paint, seen by one camera.
struct EditScene {
  BenchMesh mesh;
  Camera camera;
  render::ModelHandle model = 0;
};

struct EditCost {
  double ms = 0;                               // until a frame may show the edit
  double ms_to_memory = 0;                     // until main memory also has it; 0: not measured
  double gpu_ms = 0;                           // measured by the GPU; 0: unknown
  std::uint64_t cells = 0;                     // painted texels or leaves
  std::uint64_t bytes_up = 0, bytes_down = 0;  // between CPU and GPU
};

// The size and time of the data that must exist before the first edit.
struct EditCreation {
  double structure_s = 0;
  std::uint64_t model_bytes = 0;      // of the mesh or tree
  std::uint64_t structure_bytes = 0;  // additional bytes for this resolution
  std::uint64_t layer_bytes = 0;      // one fully painted layer of 8 bits
};

// One method of painting a dab. The constructor makes all data. `creation` reports the cost of that
// data, and `edit` does not include it. Neither includes the cost of the scene's depth, which every
// method except rays uses and which the renderer has anyway.
class EditMethod {
 public:
  virtual ~EditMethod() = default;
  virtual std::string name() const = 0;
  virtual EditCost edit(glm::dvec2 center, double radius_px) = 0;
  virtual EditCreation creation() const = 0;
};

// The agreement of tiles and the paper about painted surface texels. Where they differ,
// double-precision arithmetic shows which one is wrong.
struct EditAgreement {
  std::uint64_t compared = 0;  // texels that tiles or the paper painted
  std::uint64_t differ = 0;
  std::uint64_t tiles_off = 0, paper_off = 0;
  std::uint64_t beyond_rounding = 0;  // differing texels that are not near a threshold

  EditAgreement& operator+=(const EditAgreement& other) {
    compared += other.compared;
    differ += other.differ;
    tiles_off += other.tiles_off;
    paper_off += other.paper_off;
    beyond_rounding += other.beyond_rounding;
    return *this;
  }
};

// The methods of one scene and texture size, made from `names`: tiles, paper, paper-compute, octree
// and octree-fair. `not_made` lists the methods that cannot be made.
class EditMethods {
 public:
  EditMethods(render::Renderer& renderer, const EditScene& scene, int texture,
              const std::vector<std::string>& names);
  ~EditMethods();
  const std::vector<std::unique_ptr<EditMethod>>& all() const { return methods_; }
  EditMethod* find(const std::string& name) const;
  const std::vector<std::string>& not_made() const { return not_made_; }
  const mesh::SurfaceMap* map() const { return map_.get(); }

  EditAgreement compare_tiles_and_paper(glm::dvec2 center, double radius_px);  // needs both methods

 private:
  class Paper;
  class Tree;
  render::Renderer& renderer_;
  const EditScene& scene_;
  std::shared_ptr<const mesh::SurfaceMap> map_;
  std::shared_ptr<Paper> paper_;
  std::vector<std::unique_ptr<EditMethod>> methods_;
  std::vector<std::string> not_made_;
};

// Returns the rate at which a large copy reads and writes, in bytes per second. The copy runs on
// the device that edits: on all cores, or on the GPU.
double copy_bandwidth(render::Renderer& renderer);

}  // namespace strata::bench
