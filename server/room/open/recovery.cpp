// Recovery of an open room. After a lost context, the room makes its copies on the GPU again. If
// the journal contains more edits than the mirrors, the room reads the layers from it again. Both
// happen while the pipeline is paused and no edit is in progress, so nothing else changes the
// layers. In the same way, the room reads the model, its layers and its images again after the node
// had no lease. A failed recovery is repeated until the room is closed. Waiting edits are refused
// after each attempt.
#include <boost/asio/post.hpp>

#include <algorithm>

#include "core/log.h"
#include "room/open/open_layers.h"
#include "room/open/open_participants.h"
#include "room/open/open_room.h"
#include "room/open/open_surface_images.h"

namespace strata::room {
void OpenRoom::gpu_lost() {
  boost::asio::post(strand_, [self = shared_from_this()] {
    ++self->recovery_.gpu_losses;
    self->recovery_.gpu_lacks_all = true;
    self->pipeline_->pause();
  });
}

void OpenRoom::journal_differs() {
  recovery_.journal_differs = true;
  pipeline_->pause();
}

void OpenRoom::paused() { recover(); }

void OpenRoom::recover() {
  if (recovery_.working || recovery_.closed) return;
  recovery_.timer.cancel();
  if (recovery_.gpu_lacks_all) {  // the first step, because viewing needs no database
    recovery_.working = true;
    services_.renderer.remove_model(model_handle());  // the memory may be too small for two models
    boost::asio::post(
        services_.workers, [self = shared_from_this(), losses = recovery_.gpu_losses] {
          auto contents = fill_gpu(self->services_.renderer, {self->geometry_, self->coarser_},
                                   self->layer_states());
          boost::asio::post(self->strand_, [self, losses, contents = std::move(contents)] {
            self->on_gpu_filled(losses, contents);
          });
        });
  } else if (recovery_.journal_differs) {
    recovery_.working = true;
    boost::asio::post(services_.workers, [self = shared_from_this()] {
      auto contents = read_journal(self->services_.store, self->model_id_, self->layer_states());
      boost::asio::post(self->strand_, [self, contents = std::move(contents)]() mutable {
        self->on_journal_read(std::move(contents));
      });
    });
  } else if (recovery_.metadata_outdated) {
    recovery_.working = true;
    boost::asio::post(services_.workers, [self = shared_from_this(), up = model_.up,
                                          changes = recovery_.metadata_changes] {
      auto metadata = read_metadata(self->services_.store, self->model_id_);
      std::shared_ptr<const mesh::ContactShadow> shadow;
      if (metadata && metadata->model.up != up)
        shadow = self->make_contact_shadow(metadata->model.up);
      boost::asio::post(self->strand_, [self, changes, metadata = std::move(metadata),
                                        shadow = std::move(shadow)]() mutable {
        self->on_metadata_read(changes, metadata, std::move(shadow));
      });
    });
  } else {
    recovery_.retry_in = Recovery::kFirstRetry;
    pipeline_->resume();
  }
}

void OpenRoom::on_journal_read(Result<JournalContents> contents) {
  recovery_.working = false;
  if (recovery_.closed) return;
  if (!contents && services_.options.node && contents.error().code == ErrorCode::not_found)
    return deposed(contents.error());
  if (!contents) return retry_recovery(contents.error());
  if (contents->epoch != epoch_) return deposed(moved_to({}));
  recovery_.journal_differs = false;

  std::map<LayerId, LayerState> read, before;
  for (LayerState& state : contents->layers) read.emplace(state.layer.id, std::move(state));
  {
    std::lock_guard lock(mutex_);
    for (auto& [id, state] : read) {
      auto known = layers_.find(id);
      if (known == layers_.end() || known->second.layer.type != state.layer.type) {
        // The layer was made or widened by a request whose response was lost. This is rare, so all
        // data is uploaded again.
        recovery_.gpu_lacks_all = true;
        continue;
      }
      state.handles = known->second.handles;
      // The GPU uses these mirror objects, so they are updated in place.
      for (auto mirror : {&LayerState::mirror, &LayerState::provisional}) {
        auto tiles = (state.*mirror)->snapshot();
        (known->second.*mirror)->assign(std::move(tiles.tiles), tiles.sequence);
        state.*mirror = known->second.*mirror;
      }
      // The layer has changed since it was read.
      if (known->second.layer.version > state.layer.version) {
        const std::int64_t sequence = state.layer.sequence;
        state.layer = known->second.layer;
        state.layer.sequence = sequence;
        state.palette = known->second.palette;
      }
    }
    before = std::exchange(layers_, read);
    mirrors_share_.recount(mirror_bytes());
  }
  pipeline_->journal_read(contents->last_sequence);
  sequence_ = durable_ = contents->last_sequence;

  for (const auto& [id, tiles] : contents->differing) pipeline_->gpu_lacks(id, tiles);
  for (const auto& [id, state] : read) {
    const auto known = before.find(id);
    if (known == before.end())
      participants_part_->tell_layer(std::nullopt, state.layer);
    else if (contents->differing.contains(id) || known->second.layer.version != state.layer.version)
      participants_part_->tell_layer(known->second.layer.visibility, state.layer);
  }
  for (const auto& [id, state] : before) {
    if (read.contains(id)) continue;
    remove_layer(services_.renderer, state.handles);
    participants_part_->tell_seen(state.layer, [&](Listener& listener) {
      listener.layer_changed(Listener::LayerChange::deleted, state.layer);
    });
  }
  participants_part_->styles_changed();
  log::info("model " + to_string(model_id_) + " was read from the journal again, up to edit " +
            std::to_string(contents->last_sequence));
  recover();
}

void OpenRoom::on_metadata_read(int changes_before, const Result<ModelMetadata>& metadata,
                                std::shared_ptr<const mesh::ContactShadow> shadow) {
  recovery_.working = false;
  if (recovery_.closed) return;
  if (changes_before != recovery_.metadata_changes) return recover();
  if (!metadata && metadata.error().code == ErrorCode::not_found) return deposed(metadata.error());
  if (!metadata) return retry_recovery(metadata.error());
  const auto is_known = [&](const Layer& layer) {
    const LayerState* known = find_layer(layer.id);
    return known && known->layer.type == layer.type;
  };
  if (metadata->layers.size() != layers_.size() ||
      !std::ranges::all_of(metadata->layers, is_known)) {
    recovery_.journal_differs = true;  // then the metadata are read again
    return recover();
  }
  recovery_.metadata_outdated = false;
  for (const Layer& layer : metadata->layers)
    if (is_newer(layer, find_layer(layer.id)->layer)) layers_part_->replace(layer);
  surface_images_part_->replace(metadata->images);
  if (metadata->model.version > model_.version) replace_model(metadata->model, std::move(shadow));
  report_current();
  recover();
}

void OpenRoom::on_gpu_filled(int losses_before, const Result<GpuContents>& contents) {
  recovery_.working = false;
  const bool in_vain = losses_before != recovery_.gpu_losses;  // the context was lost again
  if (contents && (in_vain || recovery_.closed)) services_.renderer.remove_model(contents->model);
  if (recovery_.closed) return;
  if (in_vain) return recover();
  if (!contents) return retry_recovery(contents.error());
  recovery_.gpu_lacks_all = false;
  {
    std::lock_guard lock(mutex_);
    model_handle_ = contents->model;
    for (const auto& [id, handles] : contents->layers) {
      if (LayerState* layer = find_layer(id))
        layer->handles = handles;
      else  // a room without a claim unloads layers at any time
        remove_layer(services_.renderer, handles);
    }
  }
  maps_->set_model(contents->model);
  surface_image_cache_->set_model(contents->model);
  past_layers_->set_model(contents->model);
  pipeline_->gpu_filled();
  participants_part_->model_changed(contents->model);
  recover();
}

void OpenRoom::retry_recovery(const Error& why) {
  log::warning("model " + to_string(model_id_) +
               " could not be loaded again, trying again: " + why.title + ": " + why.detail);
  pipeline_->refuse_waiting(
      {ErrorCode::unavailable,
       "Model is reloading",
       "The server is loading the model again. The last attempt failed: " + why.detail,
       {}});
  recovery_.timer.expires_after(recovery_.retry_in);
  recovery_.retry_in = std::min(2 * recovery_.retry_in, Recovery::kLastRetry);
  recovery_.timer.async_wait(
      [self = shared_from_this()](const boost::system::error_code& cancelled) {
        if (!cancelled) self->recover();
      });
}

}  // namespace strata::room
