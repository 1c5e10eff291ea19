#include "trace/coherent_rays.hpp"

#include <limits>

#include "trace/ray_scene.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

void intersect(const RayScene& rays, const glm::vec3& origin, const CoherentDirections& directions,
               CoherentHits& hits) {
  const RayScene::Impl& scene = impl_of(rays);
  RTCRayHit16 query;
  alignas(64) int valid[coherent_rays];
  for (int i = 0; i < coherent_rays; ++i) {
    valid[i] = -1;
    query.ray.org_x[i] = origin.x;
    query.ray.org_y[i] = origin.y;
    query.ray.org_z[i] = origin.z;
    query.ray.dir_x[i] = directions.x[i];
    query.ray.dir_y[i] = directions.y[i];
    query.ray.dir_z[i] = directions.z[i];
    query.ray.tnear[i] = 0.0f;
    query.ray.tfar[i] = std::numeric_limits<float>::infinity();
    query.ray.time[i] = 0.0f;
    query.ray.mask[i] = ~0u;
    query.ray.flags[i] = 0;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene.bvh, &context, &query);
  for (int i = 0; i < coherent_rays; ++i) {
    hits.distance[i] = query.ray.tfar[i];
    hits.u[i] = query.hit.u[i];
    hits.v[i] = query.hit.v[i];
    const float towards = query.hit.Ng_x[i] * directions.x[i] +
                          query.hit.Ng_y[i] * directions.y[i] + query.hit.Ng_z[i] * directions.z[i];
    hits.side[i] = towards > 0.0f ? 1 : 0;
    if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
      hits.triangle[i] = none;
    } else if (query.hit.instID[0][i] == RTC_INVALID_GEOMETRY_ID) {
      hits.triangle[i] = scene.single_triangles.empty()
                             ? query.hit.primID[i]
                             : scene.single_triangles[query.hit.primID[i]];
    } else {
      // An instance's corners, and so its weights and its normal, may have another order.
      const glm::vec3 direction(directions.x[i], directions.y[i], directions.z[i]);
      const TriangleHit where = nearest_on_triangle(
          *scene.scene,
          scene.scene->instances[query.hit.instID[0][i]].first_triangle + query.hit.primID[i],
          glm::dvec3(origin) + double{query.ray.tfar[i]} * glm::dvec3(direction));
      hits.triangle[i] = where.triangle;
      hits.u[i] = where.u;
      hits.v[i] = where.v;
      hits.side[i] = surface_hit(*scene.scene, where, direction).side;
    }
    if (hits.triangle[i] == none ||
        scene.coincident.before(oriented(hits.triangle[i], hits.side[i])).empty()) {
      continue;
    }
    const glm::vec3 direction(directions.x[i], directions.y[i], directions.z[i]);
    const TriangleHit first =
        scene.resolve_coincident({hits.triangle[i], hits.u[i], hits.v[i]}, direction);
    if (first.triangle == hits.triangle[i]) continue;
    hits.triangle[i] = first.triangle;
    hits.u[i] = first.u;
    hits.v[i] = first.v;
    hits.side[i] = surface_hit(*scene.scene, first, direction).side;
  }
}

}  // namespace photile::trace
