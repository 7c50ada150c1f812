// SPDX-License-Identifier: Apache-2.0
#pragma once

class vtkPVDataRepresentation;

namespace pellucid::plugin {

/// Prepares a picture of a representation. Warns, once, if it has no array to color by, for it then
/// shows nothing. Has its view draw volumes after translucent geometry instead of peeling them
/// together, which ParaView's views do unless told otherwise and Pellucid's mappers refuse.
void prepare_picture(vtkPVDataRepresentation& representation, bool& is_told);

}  // namespace pellucid::plugin
