//! Tables in Parquet, with the columns that the library `datasets` of Hugging Face reads as pictures and labels.

use std::fs::File;
use std::mem;
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context as _, bail};
use parquet::basic::Compression;
use parquet::column::reader::ColumnReader;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

use super::{Archive, Entry};

/// Columns, which may be null: `datasets` has no others.
const SCHEMA: &str = "
message pictures {
    optional group image {
        optional binary bytes;
        optional binary path (UTF8);
    }
    optional int64 category;
    optional binary name (UTF8);
    optional binary label (UTF8);
}";

/// Path of the column of pictures.
const PICTURES: &str = "image.bytes";

/// Number of optional columns around a value of `image`.
const INNER: i16 = 2;

/// Features of the columns, which `datasets` finds under the key `huggingface`.
const FEATURES: &str = r#"{"info":{"features":{"image":{"_type":"Image"},"category":{"dtype":"int64","_type":"Value"},"name":{"dtype":"string","_type":"Value"},"label":{"dtype":"string","_type":"Value"}}}}"#;

/// Number of pictures of a row group.
const GROUP: usize = 1000;

/// Table with a row for each picture.
pub(super) struct Table {
    file: SerializedFileWriter<Vec<u8>>,
    group: Columns,
}

/// Columns of a row group.
#[derive(Default)]
struct Columns {
    pictures: Vec<ByteArray>,
    paths: Vec<ByteArray>,
    categories: Vec<i64>,
    names: Vec<ByteArray>,
    labels: Vec<ByteArray>,
}

impl Table {
    pub(super) fn new() -> anyhow::Result<Self> {
        let schema = Arc::new(parse_message_type(SCHEMA)?);
        let features = KeyValue::new("huggingface".into(), FEATURES.to_owned());
        let properties = WriterProperties::builder()
            // The bytes of a table do not depend on the version.
            .set_created_by("kfrac".into())
            // Pictures are compressed already. All values but names differ.
            .set_compression(Compression::UNCOMPRESSED)
            .set_statistics_enabled(EnabledStatistics::None)
            .set_dictionary_enabled(false)
            .set_column_dictionary_enabled("name".into(), true)
            .set_key_value_metadata(Some(vec![features]))
            .build();
        let file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties))?;
        Ok(Self {
            file,
            group: Columns::default(),
        })
    }

    /// Writes the row group that is held.
    fn flush(&mut self) -> anyhow::Result<()> {
        let columns = mem::take(&mut self.group);
        if columns.pictures.is_empty() {
            return Ok(());
        }
        let mut group = self.file.next_row_group()?;
        write::<ByteArrayType>(&mut group, &columns.pictures, INNER)?;
        write::<ByteArrayType>(&mut group, &columns.paths, INNER)?;
        write::<Int64Type>(&mut group, &columns.categories, 1)?;
        write::<ByteArrayType>(&mut group, &columns.names, 1)?;
        write::<ByteArrayType>(&mut group, &columns.labels, 1)?;
        group.close()?;
        Ok(())
    }
}

/// Writes the next column of a group, of which no value is null. `level` is the number of optional columns around a value.
fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: &[T::T],
    level: i16,
) -> anyhow::Result<()> {
    let mut column = group
        .next_column()?
        .context("the table has no column left")?;
    let levels = vec![level; values.len()];
    let typed = column.typed::<T>();
    typed.write_batch(values, Some(&levels), None)?;
    Ok(column.close()?)
}

impl Archive for Table {
    fn add(&mut self, entry: Entry) -> anyhow::Result<()> {
        let Columns {
            pictures,
            paths,
            categories,
            names,
            labels,
        } = &mut self.group;
        let path = format!("{}/{:06}.png", entry.name, entry.instance);
        pictures.push(entry.png.into());
        paths.push(path.into_bytes().into());
        categories.push(entry.category.into());
        names.push(entry.name.into_bytes().into());
        labels.push(entry.label.into_bytes().into());
        if pictures.len() == GROUP {
            self.flush()?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> anyhow::Result<Vec<u8>> {
        self.flush()?;
        Ok(self.file.into_inner()?)
    }
}

/// Returns the pictures of a table.
pub(super) fn pictures(path: &Path) -> anyhow::Result<Vec<Vec<u8>>> {
    let file = SerializedFileReader::new(File::open(path)?)?;
    let mut pictures = Vec::new();
    for group in 0..file.num_row_groups() {
        let group = file.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows())?;
        let first = group.metadata().columns().first();
        let is_picture = first.is_some_and(|column| column.column_path().string() == PICTURES);
        if !is_picture {
            bail!("it is no table of pictures");
        }
        let ColumnReader::ByteArrayColumnReader(mut column) = group.get_column_reader(0)? else {
            bail!("it is no table of pictures");
        };
        let (mut levels, mut values) = (Vec::new(), Vec::new());
        column.read_records(rows, Some(&mut levels), None, &mut values)?;
        pictures.extend(values.into_iter().map(|bytes| bytes.data().to_vec()));
    }
    Ok(pictures)
}
