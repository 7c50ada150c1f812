// SPDX-License-Identifier: Apache-2.0
// The source of the target that owns the tests' precompiled headers: a target needs one.
