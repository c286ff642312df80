// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/pcl_terrain_peer.hpp"

#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace warren {

struct PclTerrainPeer::Cloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
};

PclTerrainPeer::CloudPtr PclTerrainPeer::make_cloud(std::span<const Point3f> points) {
  auto cloud = std::make_shared<Cloud>();
  cloud->points->reserve(points.size());
  for (const Point3f& p : points) cloud->points->push_back({p.x, p.y, p.z});
  return cloud;
}

std::vector<Point3f> PclTerrainPeer::points_of(const Cloud& cloud) {
  std::vector<Point3f> points;
  points.reserve(cloud.points->size());
  for (const pcl::PointXYZ& p : *cloud.points) points.push_back({p.x, p.y, p.z});
  return points;
}

std::size_t PclTerrainPeer::size_of(const Cloud& cloud) { return cloud.points->size(); }

PclTerrainPeer::CloudPtr PclTerrainPeer::reduce(const Cloud& cloud, float cell_m) {
  auto reduced = std::make_shared<Cloud>();
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud.points);
  grid.setLeafSize(cell_m, cell_m, cell_m);
  grid.filter(*reduced->points);
  return reduced;
}

std::vector<PeerPlane> PclTerrainPeer::fit_planes(const Cloud& cloud, int k) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud.points);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setKSearch(k);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  std::vector<PeerPlane> planes;
  planes.reserve(normals.size());
  for (const pcl::Normal& n : normals) {
    planes.push_back({{n.normal_x, n.normal_y, n.normal_z}, n.curvature});
  }
  return planes;
}

}  // namespace warren
