//! Warnings about what is recorded.

use super::{Context, Found, Table};
use crate::scene::problem::Problems;
use crate::scene::{Rate, Stepping};
use crate::trace::STREAMS;

pub fn rate_above_steps(context: &Context<'_, '_>, found: &mut Found) {
    // With an accuracy the clock is the recording's own.
    if matches!(context.scene.stepping, Stepping::Accuracy(_)) {
        return;
    }
    let (record, steps) = (&context.scene.record, 1.0 / context.scene.step);
    let mut quiet = Problems::new("", "");
    let table = context.top.table("record", &mut quiet);
    let rates = table
        .as_ref()
        .and_then(|table| table.table("rates", &mut quiet));
    let mut see = |table: &Option<Table<'_>>, key: &'static str, rate: Rate| {
        let Rate::PerSecond(rate) = rate else { return };
        // What is written as 1/60 is not quite that.
        let node = table.as_ref().and_then(|table| table.get(key));
        if let Some(node) = node.filter(|_| rate > steps * (1.0 + 1e-6)) {
            found.add(node.span, || {
                format!(
                    "{key} = {rate} a second is more than there are steps ({steps:.6} a second); take a smaller step, or a lower rate"
                )
            });
        }
    };
    see(&table, "rate", Rate::PerSecond(record.rate));
    see(&table, "state", record.state);
    for &(stream, rate) in &record.rates {
        for stream in stream.iter() {
            see(&rates, stream.name, rate);
        }
    }
}

pub fn unrecorded_rate(context: &Context<'_, '_>, found: &mut Found) {
    let mut quiet = Problems::new("", "");
    let record = context.top.table("record", &mut quiet);
    let Some(rates) = record.and_then(|table| table.table("rates", &mut quiet)) else {
        return;
    };
    for stream in STREAMS {
        if let Some(node) = rates.get(stream.name)
            && !context.scene.record.streams.contains(stream.name)
        {
            found.add(node.span, || {
                format!(
                    "{} has a rate and is not recorded; add it to [record] streams, or leave out its rate",
                    stream.name
                )
            });
        }
    }
}
