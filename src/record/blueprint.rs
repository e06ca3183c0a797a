//! A blueprint written by hand: views, containers, panels.
//!
//! The typed blueprint API of Rerun 0.36 has no way to set the properties of a view, and its ids
//! are random. Blueprints are stored like any other data, so they are written as such, with ids
//! that count up.

use super::RecordError;
use super::rrd::{RrdFile, Store};
use rerun::external::re_sdk_types::Visualizer;
use rerun::external::re_sdk_types::blueprint::archetypes as ba;
use rerun::external::re_sdk_types::blueprint::components as bc;
use rerun::external::uuid::Uuid;
use rerun::{AsComponents, EntityPath, SerializedComponentBatch, TimePoint, Timeline, components};

/// A view or a container, by its path in the blueprint.
#[derive(Clone, Debug)]
pub struct Part {
    path: String,
    id: Uuid,
}

/// A view to be made.
pub struct View<'a> {
    /// `3D`, `TimeSeries`, `TextDocument`, `TextLog`, `StateTimeline`.
    pub class: &'static str,
    pub name: &'a str,
    pub origin: &'a str,
    /// What it holds: `+ /path/**` a line.
    pub contents: Vec<String>,
    /// Its properties, by archetype.
    pub properties: Vec<(&'static str, &'a dyn AsComponents)>,
    /// What draws an entity, where it is not what Rerun would choose.
    pub visualizers: Vec<(String, Vec<Visualizer>)>,
    /// Entities shown only when their eye is clicked.
    pub hidden: Vec<String>,
}

pub struct Blueprint<'f> {
    file: &'f mut RrdFile,
    next: u128,
}

/// The typed blueprints have RFC 4122 ids (version 4); these have the same form.
const ID_BASE: u128 = 0x7027_0000_0000_4000_8000_0000_0000_0000;

impl<'f> Blueprint<'f> {
    pub fn new(file: &'f mut RrdFile) -> Self {
        Self { file, next: 0 }
    }

    pub fn log(
        &mut self,
        path: impl Into<EntityPath>,
        part: &dyn AsComponents,
    ) -> Result<(), RecordError> {
        let at = TimePoint::default().with(Timeline::new_sequence("blueprint"), 0);
        self.file.row(Store::Blueprint, path, at, &[part])
    }

    pub fn view(&mut self, view: View<'_>) -> Result<Part, RecordError> {
        let id = self.id();
        let path = format!("view/{id}");
        let query = view
            .contents
            .iter()
            .map(|line| bc::QueryExpression(line.as_str().into()));
        self.log(
            format!("{path}/ViewContents"),
            &ba::ViewContents::new(query),
        )?;
        let blueprint = ba::ViewBlueprint::new(bc::ViewClass(view.class.into()))
            .with_display_name(components::Name(view.name.into()))
            .with_space_origin(view.origin);
        self.log(path.as_str(), &blueprint)?;
        for (name, property) in view.properties {
            self.log(format!("{path}/{name}"), property)?;
        }
        for (entity, visualizers) in view.visualizers {
            self.visualizers(id, &entity, visualizers)?;
        }
        for entity in view.hidden {
            let path = format!("{path}/ViewContents/overrides{entity}/visualizers");
            self.log(path, &ba::EntityBehavior::new().with_visible(false))?;
        }
        Ok(Part { path, id })
    }

    /// Containers share their room as `shares` says, in rows or in columns by their kind.
    pub fn container(
        &mut self,
        kind: bc::ContainerKind,
        name: &str,
        contents: &[Part],
        shares: &[f32],
    ) -> Result<Part, RecordError> {
        let id = self.id();
        let path = format!("container/{id}");
        let included = contents
            .iter()
            .map(|part| bc::IncludedContent(part.path.as_str().into()));
        let mut container = ba::ContainerBlueprint::new(kind)
            .with_display_name(components::Name(name.into()))
            .with_contents(included);
        match kind {
            bc::ContainerKind::Horizontal => {
                container =
                    container.with_col_shares(shares.iter().map(|&s| bc::ColumnShare(s.into())));
            }
            bc::ContainerKind::Vertical => {
                container =
                    container.with_row_shares(shares.iter().map(|&s| bc::RowShare(s.into())));
            }
            bc::ContainerKind::Tabs | bc::ContainerKind::Grid => {}
        }
        if let (bc::ContainerKind::Tabs, Some(first)) = (kind, contents.first()) {
            container = container.with_active_tab(bc::ActiveTab(first.path.as_str().into()));
        }
        self.log(path.as_str(), &container)?;
        Ok(Part { path, id })
    }

    /// Shows `root` and nothing that Rerun would add by itself.
    pub fn finish(mut self, root: &Part) -> Result<(), RecordError> {
        let viewport = ba::ViewportBlueprint::new()
            .with_root_container(bc::RootContainer(root.id.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.log("viewport", &viewport)
    }

    fn visualizers(
        &mut self,
        view: Uuid,
        entity: &str,
        visualizers: Vec<Visualizer>,
    ) -> Result<(), RecordError> {
        let entity = EntityPath::from(entity);
        let base = ba::ViewContents::blueprint_base_visualizer_path_for_entity(view, &entity);
        let mut ids = Vec::new();
        for visualizer in visualizers {
            let id = self.id();
            let path = base.join(&EntityPath::from_single_string(id.to_string()));
            let mut instruction =
                ba::VisualizerInstruction::new(visualizer.visualizer_type.clone());
            if !visualizer.mappings.is_empty() {
                instruction = instruction.with_component_map(visualizer.mappings.clone());
            }
            self.log(path.clone(), &instruction)?;
            if !visualizer.overrides.is_empty() {
                self.log(path, &Batches(visualizer.overrides.to_vec()))?;
            }
            ids.push(bc::VisualizerInstructionId(id.into()));
        }
        self.log(base, &ba::ActiveVisualizers::new(ids))
    }

    fn id(&mut self) -> Uuid {
        self.next += 1;
        Uuid::from_u128(ID_BASE | self.next)
    }
}

/// Components that are serialised already.
struct Batches(Vec<SerializedComponentBatch>);

impl AsComponents for Batches {
    fn as_serialized_batches(&self) -> Vec<SerializedComponentBatch> {
        self.0.clone()
    }
}
