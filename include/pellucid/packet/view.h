// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The types of what goes between the renderer and its kernels. Namespace pellucid has a name of
/// its own in each kernel, so that a type of it is another type there, of the same numbers in the
/// same places. Each such type has one name outside of that namespace, which is the same on all
/// sides: PELLUCID_EACH_VIEW lists both.
///
/// A PellucidView takes the address of an object of its type and of no other. In a kernel seen()
/// returns that address, as one of the kernel's own type.
#define PELLUCID_EACH_VIEW(f)                                                           \
  f(PellucidBinnedTransfer, BinnedTransfer) f(PellucidBlockClasses, BlockClass)         \
      f(PellucidBlockRecords, BlockRecord) f(PellucidBlockVariations, BlockVariation)   \
          f(PellucidLaneMixture, LaneMixture) f(PellucidLight, PacketLight)             \
              f(PellucidMeshFields, MeshFields) f(PellucidMeshPoints, MeshPoint)        \
                  f(PellucidMultichannelGrid, MultichannelGrid)                         \
                      f(PellucidNearMixture, CulledMixture)                             \
                          f(PellucidPreintegrated, PreintegratedTable)                  \
                              f(PellucidPrimitiveSets, PrimitiveSet)                    \
                                  f(PellucidSampledMultivariate, SampledMultivariate)   \
                                      f(PellucidSamplerTransfer, SamplerTransfer)       \
                                          f(PellucidSmoothBlocks, SmoothBlocks)         \
                                              f(PellucidSteppedMixture, SteppedMixture) \
                                                  f(PellucidSurfaces, PacketSurfaces)   \
                                                      f(PellucidTetrahedra, Tetrahedra)

#define PELLUCID_DECLARE_VIEW(Name, Type) struct Name;
PELLUCID_EACH_VIEW(PELLUCID_DECLARE_VIEW)
#undef PELLUCID_DECLARE_VIEW

/// A pointer to one or several objects of the type that Name stands for; null by value
/// initialization.
template <class Name>
struct PellucidView {
  PellucidView() = default;
  /// `object` may be null. Finds the type's name by its namespace.
  template <class Type>
  requires requires(const Type* one, const Name* name) { name = name_of_view(one); }
  PellucidView(const Type* object) noexcept  // NOLINT: a typed pointer is what it is
      : name(name_of_view(object)) {}

  const Name* name;
};

namespace pellucid {

#define PELLUCID_MAP_VIEW(Name, Type)                            \
  struct Type;                                                   \
  inline const Name* name_of_view(const Type* object) noexcept { \
    return reinterpret_cast<const Name*>(object);                \
  }                                                              \
  inline const Type* seen(PellucidView<Name> view) noexcept {    \
    return reinterpret_cast<const Type*>(view.name);             \
  }
PELLUCID_EACH_VIEW(PELLUCID_MAP_VIEW)
#undef PELLUCID_MAP_VIEW

}  // namespace pellucid
