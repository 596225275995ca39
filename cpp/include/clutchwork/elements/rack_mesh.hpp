#pragma once
#include <clutchwork/elements/mesh.hpp>

namespace clutchwork::elements {

/// The same between a shaft and a mass.
struct RackMesh : declared::RackMesh, MeshFriction {
  template <class T>
  struct Params {
    T radius;             ///< [m]
    Curve<T> loss_table;  ///< 1
  };
};

}  // namespace clutchwork::elements
