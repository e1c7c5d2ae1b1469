#!/bin/sh
# Makes the tests' meshes from plate.geo, groups.geo and layers.geo with gmsh (Debian 12: 4.8.4).
set -e
cd "$(dirname "$0")"
mesh() {  # output, input, options...
  output=$1 input=$2
  shift 2
  gmsh -v 2 -2 "$@" "$input" -o "$output"
}
mesh ascii22.msh groups.geo -format msh22
mesh binary22.msh groups.geo -format msh22 -bin
mesh ascii41.msh groups.geo -format msh41
mesh binary41.msh groups.geo -format msh41 -bin
mesh all22.msh plate.geo -format msh22 -bin          # no groups: gmsh saves points and lines too
mesh all41.msh plate.geo -format msh41
mesh parametric41.msh groups.geo -format msh41 -parametric
mesh parametric41b.msh groups.geo -format msh41 -parametric -bin
mesh second_order.msh groups.geo -format msh41 -order 2
mesh quads.msh groups.geo -format msh22 -setnumber Mesh.RecombineAll 1
mesh version40.msh groups.geo -format msh40
mesh version1.msh groups.geo -format msh1
mesh plate.stl groups.geo -format stl
mesh plate.vtk groups.geo -format vtk
mesh plate.mesh groups.geo -format mesh
mesh layers22.msh layers.geo -format msh22           # triangles in several physical surfaces
mesh layers22b.msh layers.geo -format msh22 -bin
mesh layers41.msh layers.geo -format msh41
mesh layers41b.msh layers.geo -format msh41 -bin
