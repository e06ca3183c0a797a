//! By which methods a scene goes: those that it states, or what a plan for its accuracy chose.

use crate::cost::Plan;
use crate::scene::{Scene, Stepping};
use crate::sim::{Choice, Choose, Setting, Stated};

pub(super) enum Ways {
    Stated(Stated),
    Planned(Box<dyn Choose + Send>),
}

impl Ways {
    /// Of a scene that states an accuracy this takes as long as planning does.
    pub fn of(scene: &Scene) -> Result<Self, String> {
        if let Stepping::Method { .. } = scene.stepping
            && let Some(stated) = Stated::of(scene)
        {
            return Ok(Self::Stated(stated));
        }
        let plan = Plan::of(scene).map_err(|why| why.to_string())?;
        Ok(Self::Planned(Box::new(plan.chooser())))
    }
}

impl Choose for Ways {
    fn choose(&mut self, setting: &Setting<'_>) -> Choice {
        match self {
            Self::Stated(stated) => stated.choose(setting),
            Self::Planned(planned) => planned.choose(setting),
        }
    }
}
