#include "support/columns.h"

namespace oitlab::testing {

std::string nameOf(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings) text += name + "=" + value + " ";
  return text;
}

Scene columns(const std::vector<int>& depths, int rows) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  const float half = 0.5f * float(depths.size());
  for (std::size_t column = 0; column < depths.size(); ++column)
    for (int layer = 0; layer < depths[column]; ++layer) {
      const int place = (layer * 7919) % depths[column];  // a permutation: 7919 is prime
      // The depths are so close that perspective does not move a column into the next.
      const float z = -1e-5f * float(place % 4 == 3 ? place - 1 : place);
      const float left = 2.0f * (float(column) - half) / float(rows);
      const float right = left + 2.0f / float(rows), high = 2.0f, low = -2.0f;
      triangles.push_back({glm::vec3{left, low, z}, {right, low, z}, {right, high, z}});
      triangles.push_back({glm::vec3{left, low, z}, {right, high, z}, {left, high, z}});
      const glm::vec4 color{float(layer % 7) / 6, float(layer % 11) / 10, float(layer % 13) / 12,
                            0.02f + 0.02f * float(layer % 5)};
      colors.push_back(color);
      colors.push_back(color);
    }
  return triangleScene(triangles, colors, frontCamera());
}

RenderFixture columnFixture(const std::vector<int>& depths, int rows) {
  return RenderFixture(columns(depths, rows), std::uint32_t(depths.size()), std::uint32_t(rows));
}

}  // namespace oitlab::testing
