//! UNAM, Mexico, standard file of acceleration (ASA 2.0): some hundred lines `NAME : value`, whose values are lists such as
//! `/200/200/200` with one entry for each of up to twelve channels, then a column for each channel in gal, without time, in the Fortran format
//! that the header names (`3F10.4`).

use crate::Result;
use crate::ground::record::{Format as FileFormat, Raw, Record, Remark, finish};
use crate::ground::source::{
    Source, count, fixed_fields, fortran_format, missing, named, number, required, rows, unreadable,
};

/// Lines in which the header is looked for.
const HEADER: usize = 140;
const DATA: &str = "DATOS DE ACELERACION";
/// Most rows behind the last one declared: programs of the archive repeat it once or twice.
const MOST_SURPLUS: u64 = 10;
/// How far duration and number of samples may be from each other, over the duration: archives count intervals or samples.
const LENGTHS: f64 = 0.02;

pub(super) fn is_format(source: &Source) -> bool {
    let has = |mark: &str| source.head(HEADER).any(|(_, line)| line.contains(mark));
    has("ARCHIVO ESTANDAR DE ACELERACION") || (has("INTERVALO DE MUESTREO, C1-C6") && has("NUM. TOTAL DE MUESTRAS"))
}

pub(super) fn read(source: &Source) -> Result<Vec<Record>> {
    let (count_line, counts) = list(source, "NUM. TOTAL DE MUESTRAS")?;
    let (dt_line, intervals) = list(source, "INTERVALO DE MUESTREO")?;
    let names = list(source, "ORIENTACION").map_or(Vec::new(), |(_, names)| names);
    let (units_line, units) = required(source, HEADER, "UNIDADES DE LOS DATOS")?;
    let (format_line, format) = required(source, HEADER, "FORMATO DATOS")?;
    let format = fortran_format(format).filter(|format| format.per_line == counts.len());
    let format = format.ok_or_else(|| {
        unreadable(source, format_line, "FORMATO DATOS", "a Fortran format such as 3F10.4, one field a channel")
    })?;
    let data_line = data_line(source)?;
    let found = rows(source, data_line, format.per_line, true, |line| fixed_fields(line, format.width))?;
    let station = ["CLAVE DE LA ESTACION", "NOMBRE DE LA ESTACION"]
        .map(|key| named(source, HEADER, key).map_or("", |(_, text)| text));
    let event = named(source, HEADER, "FECHA DEL SISMO").map_or("", |(_, text)| text);
    let mut records = Vec::new();
    for (place, mut values) in found.columns.into_iter().enumerate() {
        let bad = |line, key, allowed| unreadable(source, line, key, allowed);
        let declared =
            count(counts[place]).ok_or_else(|| bad(count_line, "NUM. TOTAL DE MUESTRAS", "whole numbers from 2"))?;
        let dt = intervals.get(place).copied().and_then(number);
        let dt = dt.ok_or_else(|| bad(dt_line, "INTERVALO DE MUESTREO", "times in seconds, one a channel"))?;
        let surplus = (values.len() as u64).saturating_sub(declared);
        let mut remarks = Vec::new();
        if (1..=MOST_SURPLUS).contains(&surplus) {
            values.truncate(declared as usize);
            remarks.push(Remark::Surplus { samples: surplus });
        }
        if declared != values.len() as u64 {
            return Err(source.count_error(count_line, "NUM. TOTAL DE MUESTRAS", declared, values.len()).into());
        }
        refuse_other_length(source, place, declared as f64 * dt)?;
        let name = names.get(place).copied().unwrap_or("");
        let raw = Raw {
            dt,
            values,
            units: units.split('(').next().unwrap_or("").trim().into(),
            station: station.join(" ").trim().into(),
            event: event.into(),
            channel: format!("C{} {name}", place + 1).trim().into(),
            dt_line,
            units_line,
            data_line,
            remarks,
            ..Raw::of(FileFormat::UnamAsa)
        };
        records.push(finish(source, raw)?);
    }
    Ok(records)
}

/// The first line of samples: behind the titles of the columns, which a rule closes.
fn data_line(source: &Source) -> Result<usize> {
    let start = source.head(HEADER).find(|(_, line)| line.starts_with(DATA)).map(|(line, _)| line);
    let start = start.ok_or_else(|| missing(source, HEADER, DATA))?;
    let mut rules = (start..source.lines.len().min(start + 10)).filter(|line| source.line(*line).starts_with("---"));
    rules.next_back().map(|line| line + 1).ok_or_else(|| source.error_at(start, "no titles of columns follow").into())
}

/// The entries of a list of channels 1 to 6 and of the one of channels 7 to 12 that follows it.
fn list<'a>(source: &Source<'a>, name: &'static str) -> Result<(usize, Vec<&'a str>)> {
    let lines = source.head(HEADER).filter_map(|(index, line)| Some((index, line.split_once(':')?)));
    let of_name = lines.filter(|(_, (key, _))| key.starts_with(name));
    let (mut first, mut entries) = (None, Vec::new());
    for (index, (_, value)) in of_name {
        first.get_or_insert(index);
        entries
            .extend(value.trim().trim_start_matches('/').split('/').map(str::trim).filter(|entry| !entry.is_empty()));
    }
    match first {
        Some(line) if entries.is_empty() => {
            Err(unreadable(source, line, name, "one entry a channel, parted by /").into())
        }
        Some(line) => Ok((line, entries)),
        None => Err(missing(source, HEADER, name).into()),
    }
}

/// The header says the length too: where the two differ, interval or count is another one (decimated, for example).
fn refuse_other_length(source: &Source, place: usize, length: f64) -> Result<()> {
    let Ok((line, lengths)) = list(source, "DURACION DEL REGISTRO") else { return Ok(()) };
    let Some(said) = lengths.get(place).copied().and_then(number).filter(|said| *said > 0.0) else { return Ok(()) };
    if (said - length).abs() <= LENGTHS * said {
        return Ok(());
    }
    let what = format!("the header says {said} s, its samples and interval make {length} s");
    Err(source.error_at(line, what).key("DURACION DEL REGISTRO").allowed("lengths that agree").into())
}
