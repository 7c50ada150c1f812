// SPDX-License-Identifier: Apache-2.0
#include "kernel.h"
#include "pellucid/render/sample_mesh_ray.h"

namespace pellucid {

template <class T>
__device__ void cell_models(const T* in, T* out) {
  const Material<T> material[] = {{in[0], {in[1], in[2], in[3]}}, {in[4], {in[5], in[6], in[7]}}};
  const PiecewiseLinear<T> transfer{in + 8, material, 2};
  const float psi[] = {1, 0, 0, 0};
  const SegmentResult<T> found = cell_segment(static_cast<CellModel>(threadIdx.x), PsiTable{psi, 2},
                                              transfer, 1, in + 10, in + 11, in[12]);
  out[0] = found.opacity;
  out[1] = found.radiance.r;
}
PELLUCID_DEVICE_KERNEL(cell_models)

/// One ray per thread; its hits were found before.
__global__ void sample_meshes(Tetrahedra mesh, MeshFields fields, PiecewiseLinear<double> transfer,
                              MultivariateTransfer<double> multivariate, CellModel model,
                              PsiTable psi, const MeshRay* rays, RayResult* pixels) {
  const int pixel = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  pixels[3 * pixel] = sample_mesh_ray(mesh, fields, transfer, model, psi, rays[pixel], 1e-10);
  pixels[3 * pixel + 1] =
      sample_mesh_ray(mesh, fields, multivariate, model, psi, rays[pixel], 1e-10);
  pixels[3 * pixel + 2] = sample_mesh_gaussians(mesh, fields, multivariate, GaussianRule::kniss,
                                                rays[pixel], 1e-10, 0.5);
}

}  // namespace pellucid
