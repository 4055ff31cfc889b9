//! Columns as an Arrow C stream.

use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    Array, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator,
    RecordBatchOptions, UInt8Array,
};
use arrow_schema::{Field, Schema};

use crate::error::Failure;
use crate::table::Values;

/// Returns a stream of one batch with the columns.
pub(crate) fn stream(
    columns: &[(&'static str, Values)],
    rows: usize,
) -> Result<FFI_ArrowArrayStream, Failure> {
    let arrays = columns.iter().map(|(_, values)| -> Arc<dyn Array> {
        match values {
            Values::Wholes(values) => Arc::new(Int64Array::new(values.clone(), None)),
            Values::Bytes(values) => Arc::new(UInt8Array::new(values.clone(), None)),
            Values::Reals(values) => Arc::new(Float64Array::new(values.clone(), None)),
            Values::Flags(values) => Arc::new(BooleanArray::from(values.clone())),
        }
    });
    let arrays: Vec<_> = arrays.collect();
    let fields = columns.iter().zip(&arrays);
    let fields: Vec<_> = fields
        .map(|((name, _), array)| Field::new(*name, array.data_type().clone(), false))
        .collect();
    let schema = Arc::new(Schema::new(fields));
    let options = RecordBatchOptions::new().with_row_count(Some(rows));
    let batch = RecordBatch::try_new_with_options(Arc::clone(&schema), arrays, &options);
    let batches = RecordBatchIterator::new([batch], schema);
    Ok(FFI_ArrowArrayStream::new(Box::new(batches)))
}
