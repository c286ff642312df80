// SPDX-License-Identifier: Apache-2.0
#include "tools/world/caster.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include <embree3/rtcore.h>

namespace warren::world {

struct Caster::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Scene() : device(rtcNewDevice("threads=1,isa=sse2")) {
    assert(device != nullptr);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void build(const TriangleMesh& mesh);
};

namespace {

// Embree owns the copy: buffers that are shared must be padded beyond their last vertex.
template <class Scalar, class Item>
void copy_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                 const std::vector<Item>& items) {
  if (items.empty()) return;
  auto* const buffer = static_cast<Scalar*>(
      rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(Scalar), items.size()));
  assert(buffer != nullptr);
  for (std::size_t i = 0; i < items.size(); ++i) std::copy_n(items[i].data(), 3, buffer + 3 * i);
}

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = ray.origin.x();
  out.org_y = ray.origin.y();
  out.org_z = ray.origin.z();
  out.dir_x = ray.direction.x();
  out.dir_y = ray.direction.y();
  out.dir_z = ray.direction.z();
  out.tnear = 0.0F;
  out.tfar = ray.max_range_m;
  out.mask = ~0U;
  return out;
}

RTCRayHit intersect(RTCScene scene, const Ray& ray) {
  RTCRayHit hit{};
  hit.ray = to_embree(ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
  return hit;
}

}  // namespace

void Caster::Scene::build(const TriangleMesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  copy_buffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
  copy_buffer<std::uint32_t>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  assert(rtcGetDeviceError(device) == RTC_ERROR_NONE);
}

Caster::Caster(const TriangleMesh& mesh) : mesh_(&mesh), scene_(std::make_unique<Scene>()) {
  scene_->build(mesh);
}
Caster::~Caster() = default;
Caster::Caster(Caster&&) noexcept = default;
Caster& Caster::operator=(Caster&&) noexcept = default;

std::optional<RayReturn> Caster::cast(const Ray& ray) const {
  const RTCRayHit hit = intersect(scene_->scene, ray);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Eigen::Vector3f normal(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z);
  return RayReturn{
      .range_m = hit.ray.tfar, .triangle = hit.hit.primID, .normal = normal.normalized()};
}

float Caster::range_m(const Ray& ray) const {
  const RTCRayHit hit = intersect(scene_->scene, ray);
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity()
                                                   : hit.ray.tfar;
}

bool Caster::is_occluded(const Ray& ray) const {
  RTCRay embree_ray = to_embree(ray);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &embree_ray);
  return embree_ray.tfar < 0.0F;  // Embree's way of saying yes
}

bool Caster::is_occluded(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  const float range_m = (to - from).norm();
  return range_m > 0.0F && is_occluded(Ray{from, (to - from) / range_m, range_m});
}

std::optional<RayReturn> Caster::down(const Eigen::Vector3f& from, float reach_m) const {
  return cast(Ray{from, -Eigen::Vector3f::UnitZ(), reach_m});
}

}  // namespace warren::world
