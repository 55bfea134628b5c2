#pragma once
// Polygons for ParaView (.vtp).

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace elastogear::io {

/// Writes polygons (vertex numbers into `points`, m) with integer data per polygon; ASCII XML, renamed when
/// complete. Throws Error when a data array does not have one value per polygon.
void write_polydata(const std::string& path, const std::vector<Eigen::Vector3d>& points,
                    const std::vector<std::vector<int>>& polygons,
                    const std::map<std::string, std::vector<int>>& cell_data);

}  // namespace elastogear::io
