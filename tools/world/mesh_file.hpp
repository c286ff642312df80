// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/world/triangle_mesh.hpp"

namespace warren::world {

struct MeshImport {
  // Which axis of the file points up. What a file says of itself is not trusted: of the Collada
  // files that we use, every second one is wrong.
  enum class Up : std::uint8_t { kY, kZ };
  Up up = Up::kZ;
  std::vector<std::string>
      leave_out;  // names of nodes of the scene; what hangs below them goes as well
};
// A mesh in any format that assimp reads, all kImported; an error names the file and why.
tl::expected<TriangleMesh, std::string> import_mesh(const std::filesystem::path& file,
                                                    const MeshImport& settings = {});

// Binary little-endian PLY: vertices as floats, faces with a property `surface` (of Surface).
tl::expected<void, std::string> write_ply(const std::filesystem::path& file,
                                          const TriangleMesh& mesh);

}  // namespace warren::world
