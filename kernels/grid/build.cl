// The kernels of the build as one program: the time that a runtime needs to find a compiled program
// in its cache, or to begin to compile it, is paid per program (PoCL reads all of OpenCL's built-in
// functions).

#include "grid/copy_records.cl"
#include "grid/count_photons.cl"
#include "grid/fill_cells.cl"
#include "grid/size_grids.cl"
#include "grid/sort_cells.cl"
#include "shared/scan.cl"
