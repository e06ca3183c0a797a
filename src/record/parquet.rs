//! An export as Parquet: columns of f64, null where a number is not known.

use super::export::Export;
use ::parquet::basic::{LogicalType, Repetition, Type as Physical};
use ::parquet::column::writer::ColumnWriter;
use ::parquet::data_type::ByteArray;
use ::parquet::errors::{ParquetError, Result};
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

impl Export<'_> {
    /// The columns of [`csv`](Self::csv), as Parquet without compression.
    pub fn parquet(&self, out: impl Write + Send) -> io::Result<()> {
        written(self, out).map_err(|error| match error {
            ParquetError::External(inner) => match inner.downcast::<io::Error>() {
                Ok(inner) => *inner,
                Err(other) => io::Error::other(other),
            },
            error => io::Error::other(error),
        })
    }
}

fn written(export: &Export<'_>, out: impl Write + Send) -> Result<()> {
    let properties = Arc::new(WriterProperties::builder().build());
    let mut file = SerializedFileWriter::new(out, Arc::new(schema(export)?), properties)?;
    let mut group = file.next_row_group()?;
    let mut index = 0;
    while let Some(mut column) = group.next_column()? {
        match column.untyped() {
            ColumnWriter::Int64ColumnWriter(writer) => {
                let numbers: Vec<i64> = export.labels().map(|(number, _)| number).collect();
                writer.write_batch(&numbers, None, None)?;
            }
            ColumnWriter::ByteArrayColumnWriter(writer) => {
                let names = export.labels().map(|(_, body)| ByteArray::from(body));
                writer.write_batch(&names.collect::<Vec<_>>(), None, None)?;
            }
            ColumnWriter::DoubleColumnWriter(writer) => {
                let all: Vec<Option<f64>> = export.column(index).collect();
                let known: Vec<f64> = all.iter().flatten().copied().collect();
                let levels: Vec<i16> = all.iter().map(|x| i16::from(x.is_some())).collect();
                writer.write_batch(&known, Some(&levels), None)?;
                index += 1;
            }
            _ => return Err(ParquetError::General("a column of another kind".to_owned())),
        }
        column.close()?;
    }
    group.close()?;
    file.close()?;
    Ok(())
}

fn schema(export: &Export<'_>) -> Result<Type> {
    let recording = Type::primitive_type_builder("recording", Physical::INT64)
        .with_repetition(Repetition::REQUIRED)
        .build()?;
    let body = Type::primitive_type_builder("body", Physical::BYTE_ARRAY)
        .with_logical_type(Some(LogicalType::String))
        .with_repetition(Repetition::REQUIRED)
        .build()?;
    let mut fields = vec![Arc::new(recording), Arc::new(body)];
    for name in export.names() {
        let number = Type::primitive_type_builder(name, Physical::DOUBLE)
            .with_repetition(Repetition::OPTIONAL)
            .build()?;
        fields.push(Arc::new(number));
    }
    Type::group_type_builder("numbers")
        .with_fields(fields)
        .build()
}
