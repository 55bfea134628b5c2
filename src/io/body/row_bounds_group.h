#pragma once
// Group /surface/bounds of a body file: what is known of the rows of /surface/Phi without reading them. Files
// of earlier programs do not have it.

#include "elastogear/model/elastic_body.h"
#include "io/hdf5/schema.h"

namespace elastogear::io {

/// Nothing is written of a body without such bounds.
void write_row_bounds(const h5::File& file, const model::ElasticBody& body);

bool has_row_bounds(const h5::File& file);
/// The rows of /surface/Phi, which are read when they are asked for. The file is kept open: one that takes
/// its place while a run reads on is another body's. body: with its matrices. Throws Error for bounds of
/// another shape; reading throws Error for rows that have other bounds.
model::LazyRows lazy_rows(const h5::File& file, const model::ElasticBody& body);

}  // namespace elastogear::io
