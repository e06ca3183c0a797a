//! Warnings about what is recorded.

use super::{Context, Found};
use crate::scene::problem::Problems;
use crate::scene::{StateRate, Stepping};

pub fn rate_above_steps(context: &Context<'_, '_>, found: &mut Found) {
    // With an accuracy the clock is the recording's own.
    if matches!(context.scene.stepping, Stepping::Accuracy(_)) {
        return;
    }
    let (record, steps) = (&context.scene.record, 1.0 / context.scene.step);
    let table = context.top.table("record", &mut Problems::new("", ""));
    let mut see = |key: &'static str, rate: f64| {
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
    see("rate", record.rate);
    if let StateRate::PerSecond(rate) = record.state {
        see("state", rate);
    }
}
