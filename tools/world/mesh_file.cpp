// SPDX-License-Identifier: Apache-2.0
#include "tools/world/mesh_file.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

namespace warren::world {
namespace {

static_assert(std::endian::native == std::endian::little);

Eigen::Vector3f upright(const aiVector3D& v, MeshImport::Up up) {
  // A quarter turn about x takes y to z.
  return up == MeshImport::Up::kZ ? Eigen::Vector3f(v.x, v.y, v.z)
                                  : Eigen::Vector3f(v.x, -v.z, v.y);
}

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const MeshImport& settings)
      : scene_(scene), settings_(settings) {}

  TriangleMesh read() {
    add_node(*scene_.mRootNode, aiMatrix4x4());
    mesh_.surfaces.assign(mesh_.triangles.size(), Surface::kImported);
    return std::move(mesh_);
  }

 private:
  void add_node(const aiNode& node, const aiMatrix4x4& T_world_parent) {
    const auto& unwanted = settings_.leave_out;
    if (std::find(unwanted.begin(), unwanted.end(), node.mName.C_Str()) != unwanted.end()) return;
    const aiMatrix4x4 T_world_node = T_world_parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      add_mesh(*scene_.mMeshes[node.mMeshes[i]], T_world_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], T_world_node);
  }

  void add_mesh(const aiMesh& mesh, const aiMatrix4x4& T_world_mesh) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i)
      mesh_.vertices.push_back(upright(T_world_mesh * mesh.mVertices[i], settings_.up));
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      // Points and lines survive triangulation as they are.
      if (face.mNumIndices != 3) continue;
      mesh_.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }

  const aiScene& scene_;
  const MeshImport& settings_;
  TriangleMesh mesh_;
};

void put(std::string& bytes, const void* value, std::size_t size) {
  bytes.append(static_cast<const char*>(value), size);
}

std::string ply_header(const TriangleMesh& mesh) {
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\ncomment metres, z up; surfaces:";
  for (std::size_t i = 0; i < kSurfaceCount; ++i)
    header << ' ' << i << '=' << name_of(static_cast<Surface>(i));
  header << "\nelement vertex " << mesh.vertices.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
         << mesh.triangles.size()
         << "\nproperty list uchar uint vertex_indices\nproperty uchar surface\nend_header\n";
  return header.str();
}

std::string ply_of(const TriangleMesh& mesh) {
  std::string bytes = ply_header(mesh);
  for (const Eigen::Vector3f& vertex : mesh.vertices) put(bytes, vertex.data(), 12);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    constexpr std::uint8_t kCorners = 3;
    put(bytes, &kCorners, 1);
    put(bytes, mesh.triangles[i].data(), 12);
    put(bytes, &mesh.surfaces[i], 1);
  }
  return bytes;
}

}  // namespace

tl::expected<TriangleMesh, std::string> import_mesh(const std::filesystem::path& file,
                                                    const MeshImport& settings) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Joining would be in vain while normals and texture coordinates tell vertices apart.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                  aiComponent_COLORS | aiComponent_TEXCOORDS);
  const aiScene* const scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_RemoveComponent |
                                           aiProcess_JoinIdenticalVertices);
  if (scene == nullptr || scene->mRootNode == nullptr)
    return tl::unexpected("cannot read the mesh " + file.string() + ": " +
                          importer.GetErrorString());
  TriangleMesh mesh = SceneReader(*scene, settings).read();
  if (mesh.triangles.empty())
    return tl::unexpected("there is no triangle in the mesh " + file.string());
  return mesh;
}

tl::expected<void, std::string> write_ply(const std::filesystem::path& file,
                                          const TriangleMesh& mesh) {
  const std::string bytes = ply_of(mesh);
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) return tl::unexpected("cannot write " + file.string() + ": " + std::strerror(errno));
  return {};
}

}  // namespace warren::world
